// Where the surface of a body is at a moment for which all of it is known: of a body that keeps its form, or at
// a sample of one that moves.
#pragma once

#include <cmath>
#include <vector>

#include "physics/contact/body/body_form.h"

namespace weft::physics {

struct BodyPose {
  // With the vertices there.
  BodyPose(const BodyForm& form, std::vector<Vec3> vertices);

  std::size_t bytes() const;
  // The least radius of a feature, infinite where none sticks out [m].
  double least_radius() const { return least_radii[0]; }

  std::vector<Vec3> vertices;
  std::vector<Vec3> face_normals;    // unit
  std::vector<Vec3> vertex_normals;  // the same; none until somebody needs those of a lasting pose
  std::vector<std::vector<AlignedBox>> boxes;  // of the nodes of the parts' trees
  std::vector<AlignedBox> feature_boxes;       // of those of the features' tree
  // m; of curvature of each feature, 0 where it is sharp, infinite where it does not stick out; and the least
  // below each node of their tree.
  std::vector<double> radii, least_radii;
  AlignedBox bounds;
};

// The least radius of a feature with the vertices there, without a pose.
double least_radius_of(const BodyForm& form, const std::vector<Vec3>& vertices);

inline Vec3 unit(const Vec3& a) {
  return times(a, 1 / std::max(length(a), 1e-300));
}

// Of two unit vectors [rad], by operations that have the same bits everywhere, to 1e-11.
double angle_between(const Vec3& u, const Vec3& v);

// The normal of a vertex: those of its triangles, weighted by their angles there (Baerentzen and Aanaes 2005).
// corners(triangle), normal(triangle): where they are and how they look.
template <class Corners, class Normal>
Vec3 normal_at(const BodyForm& form, int vertex, Corners&& corners, Normal&& normal) {
  Vec3 sum{};
  for (const int n : form.at_vertex(vertex)) {
    const auto& t = form.triangles[std::size_t(n)];
    const std::size_t k = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
    const auto x = corners(n);
    const Vec3 on = minus(x[(k + 1) % 3], x[k]), back = minus(x[(k + 2) % 3], x[k]);
    sum = plus(sum, times(normal(n), angle_between(unit(on), unit(back))));
  }
  return unit(sum);
}

}  // namespace weft::physics
