#include "scene/mesh/closed.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/mesh/faces.h"
#include "scene/pins.h"
#include "weft/mesh.h"
#include "weft/vec3.h"

namespace weft {

double enclosed_volume(const Cloth& cloth) {
  const std::vector<Vec3> x = placed_vertices(cloth.mesh);
  const EnclosingSurface surface = enclosing_surface(cloth);
  std::vector<Vec3> points(surface.members.size(), Vec3{});
  for (std::size_t p = 0; p < points.size(); ++p)
    for (const int vertex : surface.members[p])
      for (std::size_t k = 0; k < 3; ++k)
        points[p][k] += x[std::size_t(vertex)][k] / double(surface.members[p].size());
  double volume = 0;
  for (const auto& [i, j, k] : surface.triangles) {
    const Vec3 a = minus(points[std::size_t(i)], points[0]);
    const Vec3 b = minus(points[std::size_t(j)], points[0]);
    const Vec3 c = minus(points[std::size_t(k)], points[0]);
    volume += dot(a, cross(b, c)) / 6;
  }
  return volume;
}

EnclosingSurface enclosing_surface(const Cloth& cloth) {
  const TriangleMesh& mesh = *cloth.mesh.shape;
  EnclosingSurface surface;
  std::vector<int> point(mesh.vertices.size(), -1);
  for (const std::vector<int>& group : sewn_vertices(cloth)) {
    for (const int vertex : group) point[std::size_t(vertex)] = int(surface.members.size());
    surface.members.push_back(group);
  }
  for (std::size_t v = 0; v < point.size(); ++v) {
    if (point[v] >= 0) continue;
    point[v] = int(surface.members.size());
    surface.members.push_back({int(v)});
  }
  for (const auto& [a, b, c] : mesh.triangles)
    surface.triangles.push_back(
        {point[std::size_t(a)], point[std::size_t(b)], point[std::size_t(c)]});
  return surface;
}

namespace text {
namespace {

// A side of a triangle, as it goes round.
struct Side {
  int from, to, triangle, corner;
  std::pair<int, int> edge() const { return {std::min(from, to), std::max(from, to)}; }
};

// The first edge, by triangles, that has not two triangles on its two sides.
std::optional<Side> open_side(const EnclosingSurface& surface) {
  std::vector<Side> sides;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      sides.push_back({surface.triangles[t][k], surface.triangles[t][(k + 1) % 3], int(t), int(k)});
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tuple(a.edge(), a.triangle) < std::tuple(b.edge(), b.triangle);
  });
  std::optional<Side> first;
  for (std::size_t n = 0; n < sides.size();) {
    std::size_t end = n;
    while (end < sides.size() && sides[end].edge() == sides[n].edge()) ++end;
    const bool closed = end - n == 2 && sides[n].from == sides[n + 1].to;
    if (!closed && (!first || sides[n].triangle < first->triangle)) first = sides[n];
    n = end;
  }
  return first;
}

}  // namespace

void check_pressure(const Cloth& cloth, const std::string& place, Check& result) {
  const Pressure& pressure = cloth.pressure;
  const std::string key = place + "/pressure";
  if (!result.sound(key)) return;
  check_keys(pressure.keys, key + "/keys", result);
  if (pressure.over != 0 && pressure.inflate > 0)
    return result.fault(key, "both over and inflate are given", "one of the two");
  if (!pressure.given()) {
    if (!pressure.keys.empty())
      result.fault(key + "/keys", "keys are given alone", "with over or inflate");
    return;
  }
  if (!cloth.mesh.given()) return result.fault(key, "a grid encloses nothing", "a closed mesh");
  if (!cloth.mesh.shape || !result.sound(place + "/mesh") || !result.sound(place + "/seams"))
    return;
  if (const auto side = open_side(enclosing_surface(cloth))) {
    const auto& t = cloth.mesh.shape->triangles[std::size_t(side->triangle)];
    return result.fault(
        key,
        "the mesh is open at the edge of vertices " + std::to_string(t[std::size_t(side->corner)]) +
            " and " + std::to_string(t[std::size_t((side->corner + 1) % 3)]),
        "a closed mesh, or one that seams close: two triangles at each edge, with one outside");
  }
  if (pressure.inflate > 0 && !(std::abs(enclosed_volume(cloth)) > 1e-12))
    result.fault(key + "/inflate", "the mesh encloses no volume as it starts",
                 "over, or a mesh that encloses 1e-12 m³ at least");
}

}  // namespace text
}  // namespace weft
