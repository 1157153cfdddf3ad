// The surface of a body over a substep: where paths enter it, and what stays near to a point that goes along.
#pragma once

#include "physics/contact/body/body_moment.h"

namespace weft::physics {

struct BodyPassage {
  using Point = BodyMoment::Point;
  // What a point that moves meets: where it comes to, and, where that mattered, where it came from.
  struct Meeting {
    Point now, before;
    bool knows_before = false;
  };

  BodyMoment before, now;
  double travel = 0;  // m; no vertex comes farther

  // A body as it stands at a moment.
  static BodyPassage standing(const BodyMoment& moment) { return {moment, moment, 0}; }
  bool moves() const { return now.moves(); }
  // How far the point of a triangle has come.
  Vec3 way(int triangle, const Weights& w) const {
    return moves() ? minus(now.on(triangle, w), before.on(triangle, w)) : Vec3{};
  }

  // What a point meets that went from one place to another, each seen from where the body was then: of a closed
  // body the nearest surface, or, where it entered elsewhere, the plane there; of an open one the side on
  // which it was. `nearest`(moment, p): the nearest point, which the caller may know by less work.
  template <class Nearest>
  Meeting meet(const Vec3& from, const Vec3& to, Nearest&& nearest) const {
    Meeting m{nearest(now, to), {}, false};
    const Vec3 path = minus(to, from);
    // A path through the surface is at least as long as its ends are far from it.
    const double length = std::sqrt(dot(path, path)) + travel;
    if (length < std::abs(m.now.distance)) return m;
    if (!now.closed()) {
      m.now = on_side_of(from, to, m.now);
      return m;
    }
    m.before = nearest(before, from);
    m.knows_before = true;
    if (length >= std::abs(m.now.distance) + std::abs(m.before.distance))
      m.now = entered_at(from, to, m.before, m.now);
    return m;
  }

 private:
  // Where a path comes through the surface.
  struct Hit {
    int triangle = -1;  // none
    Weights weights{};
  };
  Hit first_on(const Vec3& from, const Vec3& to) const;
  Point entered_at(const Vec3& from, const Vec3& to, const Point& was, const Point& is) const;
  Point on_side_of(const Vec3& from, const Vec3& to, const Point& is) const;
};

}  // namespace weft::physics
