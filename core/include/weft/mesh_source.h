// Where the triangles of a cloth or a body come from.
#pragma once

#include <memory>
#include <string>

#include "weft/vec3.h"

namespace weft {

struct TriangleMesh;  // weft/mesh.h

// The triangles of a mesh file: of cloth, whose particles are the vertices in the file's order, or of a body.
// What is read is scaled, turned and then moved.
struct MeshSource {
  std::string file;  // .obj, .ply, .glb or .gltf; beside the scene file, or absolute
  double scale = 1;  // > 0; m for each unit of the file
  Vec3 rotate{};     // degrees, about x, then y, then z
  Vec3 translate{};  // m
  std::shared_ptr<const TriangleMesh> shape{};  // as read (load_meshes()), or made by a program
  bool given() const { return !file.empty() || shape; }
  // What comes from the same file is equal, read or not.
  friend bool operator==(const MeshSource& a, const MeshSource& b) {
    return a.file == b.file && a.scale == b.scale && a.rotate == b.rotate &&
           a.translate == b.translate && (!a.file.empty() || a.shape == b.shape);
  }
};

}  // namespace weft
