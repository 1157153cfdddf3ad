// The surface of a body that is a mesh: how far points are from it and on which side (angle-weighted
// pseudonormals: Baerentzen and Aanaes 2005), where paths enter it, and which of its edges and corners stick
// out. Everything is seen from the body's place [m]. What is told has the same bits whatever was asked before.
//
// A closed body consists of parts that hang together, each a solid; where they overlap, the body is the
// union: its signed distance is the least of theirs. An open one has no inside: distances are not negative,
// normals point from it to the point that asks, and what a point meets lies on the side that it came from.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "physics/contact/body/box_tree.h"
#include "physics/contact/triangle_shape.h"
#include "weft/mesh.h"

namespace weft {

class BodySurface {
 public:
  // The surface at its point nearest to one that asks.
  struct Point {
    double distance = 0;  // m, negative inside
    Vec3 normal{};        // unit; the gradient of the distance
    int triangle = 0;
  };
  // What a point that moves meets: where it comes to, and, where that mattered, where it came from.
  struct Meeting {
    Point now, before;
    bool knows_before = false;
  };
  // An edge or a corner that sticks out.
  struct Feature {
    int a = 0, b = 0;   // vertices; a corner's are one
    Vec3 normal{};      // unit, the mean of the triangles about it
    double radius = 0;  // m, of curvature; 0 where it is sharp
    int triangle = 0;   // one of them
  };
  static constexpr int kListed = 12;

  // `vertices`: those of the mesh, where they are about the place.
  BodySurface(const TriangleMesh& mesh, std::vector<Vec3> vertices);

  bool closed() const { return open_edges_.empty(); }
  std::span<const std::array<int, 2>> open_edges() const { return open_edges_; }
  const physics::AlignedBox& bounds() const { return bounds_; }
  std::size_t bytes() const;
  // The least radius of a feature, infinite where none sticks out [m]; the mean length of an edge [m].
  double least_radius() const { return least_radius_; }
  double mean_edge() const { return mean_edge_; }

  // `hint`: a triangle that may be near; makes it faster, not different.
  Point nearest(const Vec3& p, int hint = 0) const;
  // The same where it is among these triangles, which ascend.
  Point nearest_among(std::span<const int> triangles, const Vec3& p) const;
  // All triangles within a distance of p, ascending; how many, or -1 where there are more than kListed.
  int within(const Vec3& p, double distance, std::array<int, kListed>& found) const;
  // What a point meets that went from `before` to `now`: of a closed body the nearest surface, or, where it
  // entered elsewhere, the plane there; of an open one the side on which it was. `nearest`(p, whether it is
  // now): the nearest point, which the caller may know by less work.
  template <class Nearest>
  Meeting meet(const Vec3& before, const Vec3& now, Nearest&& nearest) const {
    Meeting m{nearest(now, true), {}, false};
    const Vec3 path = physics::minus(now, before);
    // A path through the surface is at least as long as its ends are far from it.
    const double way = std::sqrt(physics::dot(path, path));
    if (way < std::abs(m.now.distance)) return m;
    if (!closed()) {
      m.now = on_side_of(before, now, m.now);
      return m;
    }
    m.before = nearest(before, false);
    m.knows_before = true;
    if (way >= std::abs(m.now.distance) + std::abs(m.before.distance))
      m.now = entered_at(before, now, m.before, m.now);
    return m;
  }

  // Calls visit(feature) for those of a radius below `most` that may meet the box.
  template <class Visit>
  void features(const physics::AlignedBox& box, double most, Visit&& visit) const {
    feature_tree_.within(
        box, [&](int node) { return least_radii_[std::size_t(node)] < most; },
        [&](int n) {
          if (features_[std::size_t(n)].radius < most) visit(features_[std::size_t(n)]);
        });
  }

  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  const Vec3& face_normal(int triangle) const { return face_normals_[std::size_t(triangle)]; }
  // The triangles at a vertex.
  std::span<const int> at_vertex(int vertex) const;

 private:
  struct Candidate {
    double square = 1e300;  // m²
    int triangle = -1;
    physics::Weights weights{};
  };
  struct Part {
    int first = 0, last = 0;  // its triangles
    physics::BoxTree tree;    // of them, from its first on
  };

  physics::Triangle corners(int triangle) const;
  void look_at(int triangle, const Vec3& p, Candidate& best) const;
  Point point_of(const Candidate& c, const Vec3& p) const;
  Point nearest_in(const Part& part, const Vec3& p, int hint, double enough) const;
  // The first triangle on the way, and where [m]; -1: none.
  int first_on(const Vec3& from, const Vec3& to, Vec3& hit) const;
  Point entered_at(const Vec3& before, const Vec3& now, const Point& was, const Point& is) const;
  Point on_side_of(const Vec3& before, const Vec3& now, const Point& is) const;

  void sort_into_parts();
  void look_outward();
  void find_normals();
  void find_features();
  void plant();

  std::vector<Vec3> vertices_;
  std::vector<std::array<int, 3>> triangles_;  // part after part
  std::vector<std::array<int, 3>> beside_;  // the triangle across the edge from each corner, or -1
  std::vector<std::array<int, 2>> open_edges_;
  std::vector<int> first_at_, at_;  // the triangles at each vertex
  std::vector<Vec3> face_normals_, vertex_normals_;
  std::vector<Part> parts_;
  std::vector<Feature> features_;
  physics::BoxTree feature_tree_;
  std::vector<double> least_radii_;  // of the tree's nodes
  physics::AlignedBox bounds_;
  double least_radius_ = 0, mean_edge_ = 0;
};

}  // namespace weft
