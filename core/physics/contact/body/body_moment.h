// The surface of a body at one time: how far points are from it and on which side (angle-weighted pseudonormals:
// Baerentzen and Aanaes 2005), and which of its edges and corners stick out. Between two samples vertices, and
// with them the boxes about them, are where the line from one to the other has come to: a box that bounds a
// triangle at both ends bounds it in between. So questions cost what lies near to them, at whatever time.
#pragma once

#include <memory>

#include "physics/contact/body/body_pose.h"
#include "physics/contact/triangle_shape.h"

namespace weft::physics {

// From one value to another; exact at both ends, and monotonic in both.
inline double between(double from, double to, double share) {
  return (1 - share) * from + share * to;
}
inline Vec3 between(const Vec3& from, const Vec3& to, double share) {
  return {between(from[0], to[0], share), between(from[1], to[1], share),
          between(from[2], to[2], share)};
}

class BodyMoment {
 public:
  // The surface at its point nearest to one that asks.
  struct Point {
    double distance = 0;  // m, negative inside
    Vec3 normal{};        // unit; the gradient of the distance
    int triangle = 0;
    Weights weights{};  // of its corners
  };
  using Feature = BodyForm::Feature;

  using Pose = std::shared_ptr<const BodyPose>;
  BodyMoment() = default;
  // Of a form that lasts.
  BodyMoment(const BodyForm& form, Pose pose) : form_(&form), from_(std::move(pose)) {}
  // On the way from a sample to the next, between two times [s].
  BodyMoment(const BodyForm& form, Pose from, Pose to, double share, double begin, double end)
      : form_(&form),
        from_(std::move(from)),
        to_(std::move(to)),
        share_(share),
        begin_(begin),
        end_(end) {}

  bool closed() const { return form_->closed(); }
  bool moves() const { return to_ != nullptr; }
  const BodyForm& form() const { return *form_; }
  Vec3 vertex(int n) const {
    const auto v = std::size_t(n);
    return moves() ? between(from_->vertices[v], to_->vertices[v], share_) : from_->vertices[v];
  }
  Triangle corners(int triangle) const {
    const auto& [a, b, c] = form_->triangles[std::size_t(triangle)];
    return {vertex(a), vertex(b), vertex(c)};
  }
  Vec3 on(int triangle, const Weights& w) const {
    const Triangle t = corners(triangle);
    return plus(plus(times(t[0], w[0]), times(t[1], w[1])), times(t[2], w[2]));
  }
  Vec3 face_normal(int triangle) const;
  Vec3 vertex_normal(int vertex) const;
  // Unit, the mean of the triangles about it.
  Vec3 outward(const Feature& feature) const;
  AlignedBox bounds() const { return box(from_->bounds, moves() ? &to_->bounds : nullptr); }

  // `hint`: a triangle that may be near; makes it faster, not different.
  Point nearest(const Vec3& p, int hint = 0) const;
  // The same where it is among these triangles, which ascend.
  Point nearest_among(std::span<const int> triangles, const Vec3& p) const;
  // Whether p is inside of a part of a closed body.
  bool within_part(std::size_t part, const Vec3& p) const;

  // Whether a feature's radius is below `most`.
  bool sticks_out(int feature, double most) const {
    return radius(&BodyPose::radii, feature) < most;
  }
  // Calls visit(feature) for those whose radius is below `most` in nodes of their tree of which wanted(node) holds.
  template <class Wanted, class Visit>
  void features(double most, Wanted&& wanted, Visit&& visit) const {
    form_->feature_tree.visit(
        [&](int node) { return radius(&BodyPose::least_radii, node) < most && wanted(node); },
        [&](int n) {
          if (sticks_out(n, most)) visit(n);
        });
  }
  AlignedBox feature_box(int node) const { return box(&BodyPose::feature_boxes, node); }

  // Calls visit(triangle) for those that may meet a box on the way from here to `later`.
  template <class Visit>
  void swept(const BodyMoment& later, const AlignedBox& where, Visit&& visit) const {
    for (std::size_t n = 0; n < form_->parts.size(); ++n)
      form_->parts[n].tree.visit(
          [&](int node) {
            AlignedBox all = part_box(n, node);
            if (later.moves()) all.add(later.part_box(n, node));
            return all.meets(where);
          },
          [&](int t) { visit(form_->parts[n].first + t); });
  }

  AlignedBox part_box(std::size_t part, int node) const {
    const auto n = std::size_t(node);
    return box(from_->boxes[part][n], moves() ? &to_->boxes[part][n] : nullptr);
  }

  // The way that it lies on: from a sample to the next [s], and the moments there.
  double begin() const { return begin_; }
  double end() const { return end_; }
  BodyMoment at_begin() const { return {*form_, from_, to_, 0, begin_, end_}; }
  BodyMoment at_end() const { return {*form_, from_, to_, 1, begin_, end_}; }

 private:
  struct Candidate {
    double square = 1e300;  // m²
    int triangle = -1;
    Weights weights{};
  };

  AlignedBox box(const AlignedBox& from, const AlignedBox* to) const {
    if (!to) return from;
    return {between(from.low, to->low, share_), between(from.high, to->high, share_)};
  }
  AlignedBox box(std::vector<AlignedBox> BodyPose::*boxes, int n) const {
    return box((*from_.*boxes)[std::size_t(n)], moves() ? &(*to_.*boxes)[std::size_t(n)] : nullptr);
  }
  // In between no more than at either end.
  double radius(std::vector<double> BodyPose::*radii, int n) const {
    const double from = (*from_.*radii)[std::size_t(n)];
    return moves() ? std::min(from, (*to_.*radii)[std::size_t(n)]) : from;
  }
  void look_at(int triangle, const Vec3& p, Candidate& best) const;
  Point point_of(const Candidate& c, const Vec3& p) const;
  Point nearest_in(std::size_t part, const Vec3& p, int hint, double enough) const;

  const BodyForm* form_ = nullptr;
  Pose from_, to_;
  double share_ = 0, begin_ = -1e300, end_ = 1e300;
};

}  // namespace weft::physics
