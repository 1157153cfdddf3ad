// The triangles of a body that come near to a few points, until its next sample.
//
// What moves is seen from a place that goes along with one of them: there the points hardly move, and others come
// only so much farther as they stray from it. All triangles that come within some reach of a box about the points
// are kept. So of the nearest of them it shows by itself whether any other can be nearer; where it is, and which one,
// is found in single precision first, for few are nearest but for rounding, and between these exactly. The answer is
// that of a search of the whole surface, bit by bit.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "physics/contact/body/going_along.h"
#include "physics/kernels/body.h"

namespace weft::physics {

class NearTriangles {
 public:
  static constexpr int kMost = 256;  // a multiple of 16
  // The triangles at one time.
  struct Placed {
    bool done = false;
    float slack;  // m; so exact are distances in single precision
    alignas(64) std::array<float, kPlacedRows * kMost> rows;
  };
  // Those that may be nearest to a point.
  struct Nearest {
    double least = -1e300;  // m; none is nearer
    bool known = false;     // none but these can be the nearest
    int count = 0;
    std::array<int, kMost + 16> triangles;
    std::span<const int> all() const { return std::span(triangles).first(std::size_t(count)); }
  };

  // Looks for those within `reach` of a box now; or, where there are none, how far the nearest are. `hint`: a triangle
  // that may be near: the place goes along with it.
  void find(const BodyMoment& now, double time, const AlignedBox& about, double reach, int hint);

  // From where they are seen; what comes near is known as long as that lasts.
  const GoingAlong& along() const { return along_; }
  // No other triangle comes nearer to what is seen there [m].
  double others_from(const Vec3& seen) const {
    return reach_ - std::sqrt(about_.square_from(seen));
  }
  // None strays faster [m/s].
  double stray() const { return stray_; }
  // Those that are to what is seen there, at a time. `placed`: the triangles then.
  void nearest(const BodyKernels& kernels, const Vec3& seen, double time, Placed& placed,
               Nearest& found) const;
  std::size_t bytes() const;

 private:
  // Of `numbers_`; each is filled up to a multiple of 16.
  struct Part {
    int number, first, count;
  };
  void list(const std::vector<int>& found, const std::vector<BodyForm::Part>& parts);
  void keep(const BodyMoment& begin, const BodyMoment& end);
  bool within_another(const BodyMoment& now) const;
  void place(const BodyKernels& kernels, double time, Placed& placed) const;

  GoingAlong along_;
  AlignedBox about_;
  Vec3 middle_{};                  // of it
  double reach_ = 0, extent_ = 0;  // m; from there on, and of what is looked at
  double stray_ = 0;
  bool many_ = false;            // too many to look at all of them
  bool within_another_ = false;  // the points are in a part of which nothing is near
  std::vector<int> numbers_;     // of the triangles, part after part
  std::vector<Part> parts_;
  std::vector<float> from_, way_;  // nine rows of each
};

}  // namespace weft::physics
