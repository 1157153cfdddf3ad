// A place that goes along with a body that moves, until its next sample: seen from there what is near hardly moves.
#pragma once

#include "physics/contact/body/body_moment.h"

namespace weft::physics {

class GoingAlong {
 public:
  GoingAlong() = default;
  // From a time on [s], and before it, with the middle of a triangle.
  GoingAlong(const BodyMoment& now, double time, int triangle)
      : since_(time), begin_(now.begin()), end_(now.end()) {
    const auto middle = [&](const BodyMoment& moment) {
      return moment.on(triangle, {1 / 3., 1 / 3., 1 / 3.});
    };
    if (end_ - begin_ < 1e100)
      drift_ = times(minus(middle(now.at_end()), middle(now.at_begin())), 1 / (end_ - begin_));
  }

  bool lasts(double time) const { return time >= begin_ && time <= end_; }
  double since() const { return since_; }
  double begin() const { return begin_; }
  double end() const { return end_; }
  // The share of the way between the samples that is behind it.
  double share(double time) const { return (time - begin_) / (end_ - begin_); }
  // Where a place at a time would have been then.
  Vec3 seen(const Vec3& p, double time) const { return minus(p, way_to(time)); }
  Triangle seen(const Triangle& t, double time) const {
    return {seen(t[0], time), seen(t[1], time), seen(t[2], time)};
  }
  // All that a box comes through from sample to sample.
  AlignedBox seen(const AlignedBox& at_begin, const AlignedBox& at_end) const {
    AlignedBox all{seen(at_begin.low, begin_), seen(at_begin.high, begin_)};
    all.add({seen(at_end.low, end_), seen(at_end.high, end_)});
    return all;
  }

 private:
  Vec3 way_to(double time) const { return times(drift_, time - since_); }

  double since_ = 0, begin_ = 1e300, end_ = -1e300;  // s
  Vec3 drift_{};                                     // m/s
};

}  // namespace weft::physics
