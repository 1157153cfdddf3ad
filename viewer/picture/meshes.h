// What the graphics card holds: the cloth's surface, streamed anew for every frame, and the
// unchanging bodies of the colliders and the floor.
#pragma once

#include <vector>

#include "picture/gl.h"
#include "picture/look.h"
#include "picture/surface.h"

namespace weft::viewer {

// Vertex attributes, as common.glsl numbers them.
enum Attribute : GLuint { kPosition = 0, kNormal = 3, kTexture = 6, kForce = 7, kStrain = 10 };

class ClothMesh {
 public:
  ClothMesh();

  // Computes the surface as the look needs it and uploads it; the triangles only when they change.
  // `scene`: numbers of topology belong to one scene. `thickness` [m]: of the rim that is drawn; 0: none is.
  void update(const ClothCopy& cloth, std::uint64_t scene, const Cloth& description,
              const Look& look, Sampling sampling, float thickness);

  void draw_surface() const;
  void draw_rim() const;
  // One kind of constraint, as lines between particles; needs refinement 1.
  enum Kind { structural, shear, bend };
  void draw_lines(Kind kind) const;
  void draw_points() const;

  int vertices() const { return surface_.columns * surface_.rows; }

 private:
  struct Range {
    GLsizei count = 0;
    std::size_t offset = 0;  // indices
  };

  void draw_triangles(const Buffer& indices, std::size_t count) const;
  void upload_vertices();
  // `uv`: of the vertices; points beside tears have those of their particles, a rim those of the border.
  void upload_coordinates(std::vector<float> uv, const ClothCopy& cloth);
  void upload_triangles();
  void upload_lines(const ClothCopy& cloth, const Cloth& description);

  ClothSurface surface_;
  VertexArray array_;
  Buffer vertices_, coordinates_, indices_, tear_indices_, rim_indices_, line_indices_;
  std::vector<std::uint32_t> uploaded_;  // triangles that the card has
  Range lines_[3];
  int columns_ = 0, rows_ = 0;
  Sampling sampling_{0, 0};
  bool rim_ = false;
  std::uint64_t topology_ = ~std::uint64_t{0}, scene_ = ~std::uint64_t{0};
};

// Triangles with positions, normals and texture coordinates.
class BodyMesh {
 public:
  struct Vertex {
    Vec3f position, normal;
    float u, v;
  };
  BodyMesh(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices);
  void draw() const;

 private:
  VertexArray array_;
  Buffer vertices_, indices_;
  GLsizei count_;
};

// The shape where it stands; `size` [m] is how far a plane is drawn, `tessellation` the
// number of faces around a sphere.
BodyMesh make_body(const Shape& shape, float size, int tessellation);

// A level square of the given half side.
BodyMesh make_floor(Vec3f center, float half);

}  // namespace weft::viewer
