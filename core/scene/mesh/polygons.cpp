#include "scene/mesh/polygons.h"

#include <algorithm>

namespace weft::text {
namespace {

// Leaves out corners that are the vertex of the corner before; whether there were any.
bool drop_repeated(std::vector<Corner>& all) {
  std::vector<Corner> kept;
  for (const Corner& c : all)
    if (kept.empty() || kept.back().vertex != c.vertex) kept.push_back(c);
  while (kept.size() > 1 && kept.front().vertex == kept.back().vertex) kept.pop_back();
  const bool dropped = kept.size() < all.size();
  all = std::move(kept);
  return dropped;
}

}  // namespace

bool Polygons::add(std::vector<Corner> corners, const std::vector<TriangleMesh::Uv>& uv, int line) {
  if (corners.size() < 3) {
    raw_.fault(line, "the face has " + std::to_string(corners.size()) + " corners", "3 to 256");
    return true;
  }
  if (drop_repeated(corners))
    ++repeated_, first_repeated_ = first_repeated_ ? first_repeated_ : line;
  if (corners.size() < 3) return true;
  TriangleMesh& mesh = raw_.file.mesh;
  std::vector<Vec3> at;
  for (const Corner& c : corners) at.push_back(mesh.vertices[std::size_t(c.vertex)]);
  bool crosses = false;
  const auto cuts = triangles_of(at, &crosses);
  if (crosses) ++crossing_, first_crossing_ = first_crossing_ ? first_crossing_ : line;
  for (const std::array<int, 3>& cut : cuts) {
    if (mesh.triangles.size() == kMaxTriangles) {
      raw_.fault(line, "the mesh has more triangles", "at most 4194304");
      return false;
    }
    std::array<int, 3> vertices{};
    std::array<TriangleMesh::Uv, 3> mapped{};
    const bool has_uv =
        std::all_of(cut.begin(), cut.end(), [&](int k) { return corners[std::size_t(k)].uv >= 0; });
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner& corner = corners[std::size_t(cut[k])];
      vertices[k] = corner.vertex;
      if (has_uv) mapped[k] = uv[std::size_t(corner.uv)];
    }
    has_uv_ |= has_uv;
    mesh.triangles.push_back(vertices);
    mesh.uv.push_back(mapped);
    raw_.lines.push_back(line);
  }
  return true;
}

void Polygons::finish() {
  if (repeated_ > 0)
    raw_.note(std::to_string(repeated_) + (repeated_ == 1 ? " face repeats" : " faces repeat") +
              " a vertex, first in " + raw_.where(first_repeated_) +
              "; the repeated corners are left out");
  if (crossing_ > 0)
    raw_.note(std::to_string(crossing_) +
              (crossing_ == 1 ? " face crosses itself" : " faces cross themselves") +
              ", seen along the normal, first in " + raw_.where(first_crossing_) +
              "; triangles of it lie on each other");
  if (!has_uv_) raw_.file.mesh.uv.clear();
  if (raw_.file.mesh.triangles.empty() && raw_.file.faults.empty())
    raw_.fault(0, "the mesh has no faces", "at least one");
  if (raw_.file.faults.empty()) repair(raw_);
}

void note_welded(const RawMesh& raw, std::size_t copies) {
  if (copies == 0) return;
  raw.note(std::to_string(copies) + (copies == 1 ? " vertex lies" : " vertices lie") +
           " exactly where another one does, as copies for texture coordinates and normals do; "
           "those of one place are one");
}

}  // namespace weft::text
