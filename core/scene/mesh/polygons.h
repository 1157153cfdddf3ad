// The faces of a file as they come: polygons, cut into triangles.
#pragma once

#include "scene/mesh/faces.h"

namespace weft::text {

struct Corner {
  int vertex = 0, uv = -1;  // uv: texture coordinate, -1: none
};

class Polygons {
 public:
  explicit Polygons(RawMesh& raw) : raw_(raw) {}

  // Adds a face of vertices that the mesh has, without corners that repeat the vertex before; `line`: where it
  // is in the file. What is left of fewer than three corners is left out. False where the mesh is full.
  bool add(std::vector<Corner> corners, const std::vector<TriangleMesh::Uv>& uv, int line);
  // After the last face, where nothing was at fault: what is left is repaired, or refused.
  void finish();

 private:
  RawMesh& raw_;
  bool has_uv_ = false;
  int repeated_ = 0, first_repeated_ = 0;
  int crossing_ = 0, first_crossing_ = 0;
};

// Tells of so many vertices that were copies.
void note_welded(const RawMesh& raw, std::size_t copies);

}  // namespace weft::text
