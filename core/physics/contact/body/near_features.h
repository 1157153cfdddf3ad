// The edges and corners of a body that come near to a few triangles of cloth, until its next sample: as near_triangles.h
// for points.
#pragma once

#include <vector>

#include "physics/contact/body/body_triangle.h"
#include "physics/contact/body/going_along.h"
#include "physics/kernels/contact.h"

namespace weft::physics {

class NearFeatures {
 public:
  // Looks for those of a radius below `most` that come within `reach` of a box. `hint`: as of NearTriangles.
  void find(const BodyMoment& now, double time, const AlignedBox& about, double reach, double most,
            int hint);
  // Whether what is about a triangle is known at a time [s].
  bool know(const AboutTriangle& triangle, double time) const;
  // Those that may be there, by the order of their tree.
  std::span<const int> about(const SheetKernels& kernels, const AboutTriangle& triangle,
                             double time);
  std::size_t bytes() const;

 private:
  AlignedBox seen(const AlignedBox& box, double time) const {
    return {along_.seen(box.low, time), along_.seen(box.high, time)};
  }

  GoingAlong along_;
  AlignedBox about_;
  Vec3 middle_{};                               // of it
  double reach_ = 0, most_ = 0, rounding_ = 0;  // m
  std::vector<int> features_;
  // Of them, from the middle, low and high [m], and 16 lanes.
  std::array<std::vector<float>, 6> boxes_;
  std::vector<int> some_;       // of them
  std::vector<float> squares_;  // the same [m²]
};

}  // namespace weft::physics
