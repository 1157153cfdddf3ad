// Finds triangles that pass through each other (crossings.h).
#include "physics/contact/self/crossings.h"

#include <algorithm>
#include <cmath>

#include "physics/model/clamp_to_int.h"
#include "physics/model/cloth_model.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

struct Box {
  Vec3 low, high;
};

template <std::size_t N>
Box box_of(const std::vector<Vec3>& x, const std::array<std::int32_t, N>& corners) {
  Box b{x[std::size_t(corners[0])], x[std::size_t(corners[0])]};
  for (const std::int32_t c : corners)
    for (int k = 0; k < 3; ++k) {
      b.low[k] = std::min(b.low[k], x[std::size_t(c)][k]);
      b.high[k] = std::max(b.high[k], x[std::size_t(c)][k]);
    }
  return b;
}

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return dot(minus(d, a), cross(minus(b, a), minus(c, a)));
}

double farthest(const Vec3& a, const Vec3& b) {
  double most = 0;
  for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

// How far from the plane of a triangle with this normal rounded corners may bring what lies in it. What is far from a
// narrow triangle is taken far off by a corner's rounding.
double rounding(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c,
                double normal) {
  constexpr double kUnits = 4.0 / (1 << 24);  // of single precision
  double place = 0;
  for (const Vec3* at : {&p, &q, &a, &b, &c}) place = std::max(place, farthest(*at, {}));
  const double side = std::max({farthest(a, b), farthest(b, c), farthest(c, a)});
  const double reach = std::max({side, farthest(p, a), farthest(q, a)});
  return kUnits * place * (1 + reach * side / normal);
}

// The edge's ends lie on both sides of the triangle, by more than what rounding makes of a plane sheet, and the edge
// passes all three of its sides the same way round.
bool passes(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double of_p = volume(a, b, c, p), of_q = volume(a, b, c, q);
  if (of_p * of_q >= 0) return false;
  const double u = volume(p, q, a, b), v = volume(p, q, b, c), w = volume(p, q, c, a);
  if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) return false;
  const double normal = length(cross(minus(b, a), minus(c, a)));
  return std::min(std::abs(of_p), std::abs(of_q)) > rounding(p, q, a, b, c, normal) * normal;
}

}  // namespace

std::vector<Edge> edges_of(const std::vector<Face>& faces) {
  std::vector<Edge> edges;
  for (const Face& f : faces)
    for (int k = 0; k < 3; ++k)
      edges.push_back({std::min(f[k], f[(k + 1) % 3]), std::max(f[k], f[(k + 1) % 3])});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

namespace {

struct Entry {
  std::array<std::int32_t, 3> cell;
  std::int32_t face;
  auto operator<=>(const Entry&) const = default;
};

// A cell along an axis. Whatever the size, cells far away fall together.
std::int32_t cell_of(double x, double size) {
  return clamp_to_int(std::floor(x / size), -1000000000, 1000000000);
}

template <class Visit>
void for_each_cell(const Box& b, double size, Visit&& visit) {
  std::array<std::int32_t, 3> from, to;
  for (int k = 0; k < 3; ++k) {
    from[k] = cell_of(b.low[k], size);
    to[k] = cell_of(b.high[k], size);
  }
  for (std::int32_t i = from[0]; i <= to[0]; ++i)
    for (std::int32_t j = from[1]; j <= to[1]; ++j)
      for (std::int32_t k = from[2]; k <= to[2]; ++k) visit(std::array{i, j, k});
}

}  // namespace

void add_surface(const ClothModel& cloth, std::vector<Vec3>& x, std::vector<Face>& faces) {
  const auto first = std::int32_t(x.size());
  for (const auto& [a, b, c] : cloth.surface().triangles)
    faces.push_back({first + a, first + b, first + c});
  const std::vector<Vec3> of_cloth = cloth.particles().gather(cloth.particles().x);
  x.insert(x.end(), of_cloth.begin(), of_cloth.end());
}

void add_sewn(const ClothModel& cloth, std::vector<std::int32_t>& sewn) {
  const std::size_t first = sewn.size();
  for (int p = 0; p < cloth.particles().count(); ++p) sewn.push_back(std::int32_t(sewn.size()));
  for (const std::vector<int>& group : cloth.surface().sewn)
    for (const int p : group)
      sewn[first + std::size_t(p)] = std::int32_t(first + std::size_t(group[0]));
}

namespace {

// In how many cells faces lie, all in all.
double entries_of(const std::vector<Vec3>& x, const std::vector<Face>& faces, double size) {
  double entries = 0;
  for (const Face& f : faces) {
    const Box b = box_of(x, f);
    double cells = 1;
    for (int k = 0; k < 3; ++k) cells *= 1 + cell_of(b.high[k], size) - cell_of(b.low[k], size);
    entries += cells;
  }
  return entries;
}

// Of cells as large as the longest edge; smaller ones where most edges are far shorter, so that a few
// long ones do not bring whole sheets into one cell.
double cell_size(const std::vector<Vec3>& x, const std::vector<Face>& faces,
                 const std::vector<Edge>& edges) {
  constexpr double kLeast = 1e-9;  // m
  constexpr double kCellsOfFace = 8;
  double size = kLeast;
  for (const Edge& e : edges) {
    const Box b = box_of(x, e);
    for (int k = 0; k < 3; ++k) size = std::max(size, b.high[k] - b.low[k]);
  }
  const double most = kCellsOfFace * double(faces.size());
  while (size > 2 * kLeast && entries_of(x, faces, size / 2) <= most) size /= 2;
  return size;
}

}  // namespace

std::vector<Crossing> find_crossings(const std::vector<Vec3>& x, const std::vector<Face>& faces,
                                     const std::vector<Edge>& edges,
                                     const std::vector<std::int32_t>& sewn) {
  const auto stands_for = [&](std::int32_t p) { return sewn.empty() ? p : sewn[std::size_t(p)]; };
  const double size = cell_size(x, faces, edges);
  std::vector<Entry> entries;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for_each_cell(box_of(x, faces[f]), size, [&](const auto& cell) {
      entries.push_back({cell, std::int32_t(f)});
    });
  std::sort(entries.begin(), entries.end());
  std::vector<Crossing> crossings;
  std::vector<std::int32_t> near;
  for (const Edge& e : edges) {
    const std::int32_t a = stands_for(e[0]), b = stands_for(e[1]);
    near.clear();
    for_each_cell(box_of(x, e), size, [&](const auto& cell) {
      for (auto at = std::lower_bound(entries.begin(), entries.end(), Entry{cell, 0});
           at != entries.end() && at->cell == cell; ++at)
        near.push_back(at->face);
    });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const std::int32_t f : near) {
      const Face& t = faces[std::size_t(f)];
      const auto shared = [&](std::int32_t c) { return stands_for(c) == a || stands_for(c) == b; };
      if (std::any_of(t.begin(), t.end(), shared)) continue;
      if (passes(x[std::size_t(e[0])], x[std::size_t(e[1])], x[std::size_t(t[0])],
                 x[std::size_t(t[1])], x[std::size_t(t[2])]))
        crossings.push_back({e, f});
    }
  }
  return crossings;
}

std::int64_t count_crossings(const std::vector<Vec3>& x, const std::vector<Face>& faces,
                             const std::vector<std::int32_t>& sewn) {
  return std::int64_t(find_crossings(x, faces, edges_of(faces), sewn).size());
}

}  // namespace weft::physics
