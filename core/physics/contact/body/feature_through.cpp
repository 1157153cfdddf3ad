#include "physics/contact/body/feature_through.h"

#include <cmath>

namespace weft::physics {
namespace {

using Feature = BodyForm::Feature;

constexpr double kBeside = 1e-9;  // of a side; what passes between two triangles is not to be lost

// The way on which a triangle and a feature that touch part is across both. Where it does not lead away from all of the
// body that hangs together there, it is turned outward until it does: something else is in the way then, and holds.
class Leaning {
 public:
  Leaning(const Vec3& across, const Vec3& inward) : across_(across), inward_(inward) {}
  // What the body consists of there.
  void add(const Vec3& way) {
    const double beyond = dot(way, across_), in = dot(way, inward_);
    if (beyond > 0 && in > 0) outward_ = std::max(outward_, beyond / in);
  }
  Vec3 normal() const { return unit(minus(across_, times(inward_, outward_))); }

 private:
  Vec3 across_, inward_;
  double outward_ = 0;
};

}  // namespace

Through corner_through(const BodyPassage& body, const Feature& corner, const Corners& c,
                       double least) {
  const BodyMoment& now = body.now;
  const Vec3 tip = now.vertex(corner.a);
  Vec3 across = unit(normal_of(c.x[0], c.x[1], c.x[2])), inward{};
  const auto each_edge = [&](auto&& visit) {
    for (const int n : now.form().at_vertex(corner.a))
      for (const int v : now.form().triangles[std::size_t(n)])
        if (v != corner.a) visit(unit(minus(now.vertex(v), tip)));
  };
  each_edge([&](const Vec3& way) { inward = plus(inward, way); });
  inward = unit(inward);
  if (dot(across, inward) > 0) across = times(across, -1);
  const double depth = dot(minus(tip, c.x[0]), across);
  if (!(depth > least)) return {};
  Leaning leaning(across, inward);
  each_edge([&](const Vec3& way) { leaning.add(way); });

  Through t;
  const auto at = [&](const Vec3& normal) {
    const double along = depth / dot(normal, across);
    const Vec3 here = minus(tip, times(normal, along));
    const Vec3 e = minus(c.x[1], c.x[0]), f = minus(c.x[2], c.x[0]), x = minus(here, c.x[0]),
               n = cross(e, f);
    const double square = dot(n, n), u = dot(cross(x, f), n) / square,
                 v = dot(cross(e, x), n) / square;
    t.weights = {1 - u - v, u, v};
    t.depth = along;
    return u >= -kBeside && v >= -kBeside && u + v <= 1 + kBeside;
  };
  const Vec3 outward = times(inward, -1);
  t.outward = outward;
  const bool meets = at(outward);
  if (!meets) t.weights = nearest_on(c.x, minus(tip, times(outward, t.depth)));
  t.behind = c.at(t.weights);
  const Vec3 off = minus(t.behind, tip);
  t.beside = meets ? 0 : length(minus(off, times(inward, dot(off, inward))));
  const Through straight = t;
  t.normal = leaning.normal();
  t.meets = at(t.normal);
  if (!t.meets) {
    t = straight;
    t.normal = outward;
    t.meets = meets;
  }
  if (body.moves()) t.way = minus(tip, body.before.vertex(corner.a));
  t.before = depth - dot(minus(t.way, Corners{c.path, {}}.at(t.weights)), across);
  return t;
}

Through edge_through(const BodyPassage& body, const Feature& edge, const Corners& c, std::size_t k,
                     double least) {
  const BodyMoment& now = body.now;
  const std::size_t next = (k + 1) % 3;
  const Vec3 p = now.vertex(edge.a), e = minus(now.vertex(edge.b), p);
  const Vec3 d = minus(c.x[next], c.x[k]), r = minus(p, c.x[k]);
  Vec3 across = cross(d, e);
  const double ee = dot(e, e), dd = dot(d, d), square = dot(across, across);
  if (!(square > 1e-9 * dd * ee)) return {};
  const Vec3 own = now.face_normal(edge.triangle), other = now.face_normal(edge.other);
  const Vec3 middle = plus(own, other);
  if (dot(across, middle) < 0) across = times(across, -1);
  const double beyond = dot(r, across);
  if (!(beyond > 0 && beyond * beyond > least * least * square)) return {};
  const double size = std::sqrt(square), depth = beyond / size;
  across = times(across, 1 / size);
  const Vec3 outward = unit(middle);
  const Vec3 along = times(e, 1 / std::sqrt(ee));
  Leaning leaning(across, times(outward, -1));
  leaning.add(cross(own, along));
  leaning.add(cross(along, other));

  Through t;
  double on = 0;
  const auto at = [&](const Vec3& normal) {
    const Vec3 m = cross(e, normal);
    const double s = dot(r, m) / dot(d, m);
    t.depth = depth / dot(normal, across);
    on = dot(minus(plus(times(d, s), times(normal, t.depth)), r), e) / ee;
    t.weights = {};
    t.weights[k] = 1 - s;
    t.weights[next] = s;
    return s > 0 && s < 1 && on >= 0 && on <= 1;
  };
  t.outward = outward;
  t.beside = at(outward) ? 0 : 1e300;
  t.behind = c.at(t.weights);
  t.normal = leaning.normal();
  t.meets = at(t.normal);
  if (!t.meets) {
    t.normal = outward;
    t.meets = at(outward);
  }
  if (!t.meets) return {};
  if (body.moves()) {
    const Vec3 a = body.before.vertex(edge.a), b = body.before.vertex(edge.b);
    t.way = minus(plus(p, times(e, on)), plus(a, times(minus(b, a), on)));
  }
  t.before = depth - dot(minus(t.way, Corners{c.path, {}}.at(t.weights)), across);
  return t;
}

}  // namespace weft::physics
