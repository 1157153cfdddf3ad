// Seams of a scene: their groups of vertices, and what they cannot join (seams.h).
#include "scene/mesh/seams.h"

#include <algorithm>

#include "weft/mesh.h"

namespace weft {
namespace {

constexpr std::size_t kMostSewn = 64;  // vertices that come together in one place

bool is_vertex(const TriangleMesh& mesh, int number) {
  return number >= 0 && std::size_t(number) < mesh.vertices.size();
}

bool joins_vertices(const TriangleMesh& mesh, const Seam& seam) {
  return is_vertex(mesh, seam[0]) && is_vertex(mesh, seam[1]) && seam[0] != seam[1];
}

// Of every vertex, those that seams join it to.
std::vector<std::vector<int>> joined_to(const Cloth& cloth) {
  const TriangleMesh& mesh = *cloth.mesh.shape;
  std::vector<std::vector<int>> joined(mesh.vertices.size());
  const auto join = [&](const std::vector<Seam>& seams) {
    for (const Seam& seam : seams) {
      if (!joins_vertices(mesh, seam)) continue;
      joined[std::size_t(seam[0])].push_back(seam[1]);
      joined[std::size_t(seam[1])].push_back(seam[0]);
    }
  };
  if (cloth.sewing) join(mesh.edges);
  join(cloth.seams);
  return joined;
}

}  // namespace

std::vector<std::vector<int>> sewn_vertices(const Cloth& cloth) {
  std::vector<std::vector<int>> groups;
  if (!cloth.sewing && cloth.seams.empty()) return groups;
  const std::vector<std::vector<int>> joined = joined_to(cloth);
  std::vector<char> has_face(joined.size(), 0), met(joined.size(), 0);
  for (const auto& t : cloth.mesh.shape->triangles)
    for (const int corner : t) has_face[std::size_t(corner)] = 1;
  std::vector<int> reached;
  for (std::size_t v = 0; v < joined.size(); ++v) {
    if (met[v] || joined[v].empty()) continue;
    reached.assign(1, int(v));
    met[v] = 1;
    for (std::size_t n = 0; n < reached.size(); ++n)
      for (const int next : joined[std::size_t(reached[n])]) {
        if (met[std::size_t(next)]) continue;
        met[std::size_t(next)] = 1;
        reached.push_back(next);
      }
    std::erase_if(reached, [&](int vertex) { return !has_face[std::size_t(vertex)]; });
    std::sort(reached.begin(), reached.end());
    if (reached.size() > 1) groups.push_back(reached);
  }
  std::sort(groups.begin(), groups.end());
  return groups;
}

namespace text {
namespace {

void check_pairs(const Cloth& cloth, const std::string& place, Check& result) {
  const std::size_t count = cloth.mesh.shape->vertices.size();
  for (std::size_t k = 0; k < cloth.seams.size() && !result.full(); ++k) {
    const auto [a, b] = cloth.seams[k];
    const std::string here = place + "/seams/" + std::to_string(k);
    for (const int end : {a, b})
      if (!is_vertex(*cloth.mesh.shape, end))
        result.fault(here, "the seam's end " + std::to_string(end) + " is no vertex of the mesh",
                     "0 to " + std::to_string(count - 1));
    if (a == b)
      result.fault(here, "the seam joins vertex " + std::to_string(a) + " to itself",
                   "two vertices");
  }
}

// A triangle of which two corners are one has no area.
void check_groups(const Cloth& cloth, const std::string& place, Check& result) {
  const std::string key = place + (cloth.seams.empty() ? "/sewing" : "/seams");
  std::vector<int> group(cloth.mesh.shape->vertices.size(), -1);
  const auto groups = sewn_vertices(cloth);
  for (std::size_t n = 0; n < groups.size(); ++n) {
    if (groups[n].size() > kMostSewn)
      return result.fault(key,
                          "vertex " + std::to_string(groups[n][0]) + " and " +
                              std::to_string(groups[n].size() - 1) + " others are sewn together",
                          "at most " + std::to_string(kMostSewn) + " vertices in one place");
    for (const int vertex : groups[n]) group[std::size_t(vertex)] = int(n);
  }
  for (const auto& t : cloth.mesh.shape->triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (group[std::size_t(a)] < 0 || group[std::size_t(a)] != group[std::size_t(b)]) continue;
      return result.fault(key,
                          "vertices " + std::to_string(std::min(a, b)) + " and " +
                              std::to_string(std::max(a, b)) + " of one triangle are sewn together",
                          "at most one corner of a triangle to each group that seams make one");
    }
}

}  // namespace

void check_seams(const Cloth& cloth, const std::string& place, Check& result) {
  const char* const meshes = "with a mesh alone, not with a grid";
  if (!cloth.mesh.given()) {
    if (cloth.sewing) result.fault(place + "/sewing", "sewing is on", meshes);
    if (!cloth.seams.empty()) result.fault(place + "/seams", "seams are given", meshes);
    return;
  }
  if (!cloth.mesh.shape || !result.sound(place + "/seams")) return;
  const TriangleMesh& mesh = *cloth.mesh.shape;
  const auto out_of_it = [&](const Seam& edge) {
    return !is_vertex(mesh, edge[0]) || !is_vertex(mesh, edge[1]);
  };
  if (cloth.sewing && std::any_of(mesh.edges.begin(), mesh.edges.end(), out_of_it))
    result.fault(place + "/sewing", "a loose edge of the mesh is not of its vertices",
                 "0 to " + std::to_string(mesh.vertices.size() - 1));
  check_pairs(cloth, place, result);
  check_groups(cloth, place, result);
}

}  // namespace text
}  // namespace weft
