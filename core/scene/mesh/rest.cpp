// What a mesh is like at rest (faces.h).
#include <algorithm>
#include <cmath>

#include "scene/mesh/faces.h"
#include "weft/vec3.h"

namespace weft::text {
namespace {

constexpr double kFlat = 1e-6, kShortest = 1e-6;  // of the longest edge; m

std::string triangle_words(const TriangleMesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return "the triangle of vertices " + std::to_string(a + 1) + ", " + std::to_string(b + 1) +
         " and " + std::to_string(c + 1);
}

// The first triangle that has no area on the pattern, or an edge that is too short.
std::optional<Fault> fault_of_pattern(const ClothMesh& mesh, const std::string& place) {
  const TriangleMesh& shape = *mesh.shape;
  if (shape.uv.empty())
    return Fault{place + "/rest", "the mesh has no texture coordinates",
                 "shape, flat or a second mesh file; uv of a file with texture coordinates"};
  for (std::size_t t = 0; t < shape.uv.size(); ++t) {
    const auto& [a, b, c] = shape.uv[t];
    const auto side = [&](const TriangleMesh::Uv& p, const TriangleMesh::Uv& q) {
      return mesh.uv_scale * std::hypot(q[0] - p[0], q[1] - p[1]);
    };
    const auto [shortest, longest] = std::minmax({side(a, b), side(b, c), side(c, a)});
    const double area = mesh.uv_scale * mesh.uv_scale *
                        std::abs((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
    if (!(area > kFlat * longest * longest))
      return Fault{place + "/rest", triangle_words(shape, t) + " has no area on the pattern",
                   "texture coordinates of all corners that are not in line"};
    if (shortest < kShortest)
      return Fault{place + "/uv_scale",
                   triangle_words(shape, t) + " has an edge below 1e-6 m on the pattern",
                   "edges of at least 1e-6 m"};
  }
  return {};
}

std::optional<Fault> fault_of_second(const ClothMesh& mesh, const std::string& place) {
  const TriangleMesh &shape = *mesh.shape, &rest = *mesh.at_rest.shape;
  if (rest.vertices.size() != shape.vertices.size() ||
      rest.triangles.size() != shape.triangles.size())
    return Fault{place + "/rest",
                 "the shape at rest has " + std::to_string(rest.vertices.size()) +
                     " vertices and " + std::to_string(rest.triangles.size()) + " triangles",
                 std::to_string(shape.vertices.size()) + " and " +
                     std::to_string(shape.triangles.size()) + ", as the mesh has"};
  const auto other =
      std::mismatch(shape.triangles.begin(), shape.triangles.end(), rest.triangles.begin());
  if (other.first != shape.triangles.end())
    return Fault{place + "/rest",
                 triangle_words(shape, std::size_t(other.first - shape.triangles.begin())) +
                     " is another one at rest",
                 "the same faces in the same order; a quadrilateral is cut along its shorter "
                 "diagonal, triangles stay as they are"};
  MeshSource scaled = mesh.at_rest;
  scaled.scale = mesh.scale;
  if (auto wrong = fault_of(scaled, place)) {
    wrong->what += ", at rest";
    return wrong;
  }
  return {};
}

}  // namespace

std::optional<Fault> fault_of_rest(const ClothMesh& mesh, const std::string& place) {
  if (mesh.rest == MeshRest::uv) return fault_of_pattern(mesh, place);
  if (mesh.rest == MeshRest::file && mesh.at_rest.shape) return fault_of_second(mesh, place);
  return {};
}

}  // namespace weft::text
