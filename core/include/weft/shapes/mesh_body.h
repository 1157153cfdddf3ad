#pragma once

#include "weft/mesh_source.h"
#include "weft/shapes/value.h"

namespace weft {

class BodySurface;  // of a mesh, made ready for questions about distances (load_meshes())
struct PointCache;  // weft/point_cache.h

// A body of any shape: the triangles of a mesh file. Where every edge has two triangles, it is closed, and
// the cloth is kept out of it, whichever way its faces look; else it is a surface without an inside, which
// cloth does not cross: what is on one side of it stays there. Its place is `translate`. Parts of a closed
// one may overlap. At least one triangle, edges of at least 1e-6 m.
struct MeshBody : MeshSource {
  std::shared_ptr<const PointCache> motion{};  // of its vertices, as read; null: it keeps its form
  std::shared_ptr<const BodySurface> surface{};  // of both, scaled and turned (load_meshes())
  double time = 0;  // s; what is asked of the shape by itself is asked of it as it is then
  Vec3 turn{};      // degrees, as `rotate`, and after it; about its place: shape_at()

  // Infinite, as it is not known; of an open one 0, for its offset is all.
  double half_thickness() const;
  // Besides the file.
  template <class Self, class Visit>
  static void values(Self& self, Visit&& visit) {
    visit("scale", self.scale, ShapeValue::length);
    visit("rotate", self.rotate, ShapeValue::angles);
    visit("translate", self.translate, ShapeValue::place);
  }
  friend bool operator==(const MeshBody& a, const MeshBody& b) {
    return static_cast<const MeshSource&>(a) == static_cast<const MeshSource&>(b) &&
           a.time == b.time && a.turn == b.turn && (!a.file.empty() || a.motion == b.motion);
  }
};

}  // namespace weft
