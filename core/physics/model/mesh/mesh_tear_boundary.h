// What each side of a tear keeps of the triangles of a mesh that it passes through, as that of a grid
// (lattice/tear_boundary.h): a tear crosses edges in their middles, and each vertex draws its own share of such a
// triangle, up to where that middle would lie if the mesh on its side went on as it is.
//
// Points are x_p + α (x_a - x_p) + β (x_b - x_p), with a whole triangle p, a, b that goes on most nearly in their
// direction; α and β are from the shape at rest. Where p has no whole triangle left, nothing is drawn.
#pragma once

#include "physics/model/mesh/mesh_tearing.h"
#include "physics/model/torn_triangle.h"

namespace weft::physics {

class MeshTearBoundary {
 public:
  // Follows the tearing, if its version has changed, and puts all points where they are now.
  void update(const MeshTearing& tearing);

  const std::vector<std::array<float, 3>>& points() const { return places_; }  // m
  // Of points: the lane of the vertex that each goes with.
  const std::vector<std::uint32_t>& owners() const { return owners_; }
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  std::size_t bytes() const;

 private:
  struct Point {
    std::uint32_t vertex, a, b;  // lanes
    float along_a, along_b;
  };

  void rebuild(const MeshTearing& tearing);
  void add_shares(const MeshTearing& tearing, std::size_t triangle);
  TornPoint point(const MeshTearing& tearing, int vertex, const Vec3& way);
  void add(const std::array<TornPoint, 3>& corners);

  std::uint64_t version_ = 0;
  std::vector<Point> points_;
  std::vector<std::uint32_t> owners_;
  std::vector<std::array<float, 3>> places_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace weft::physics
