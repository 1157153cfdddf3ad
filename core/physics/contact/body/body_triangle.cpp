#include "physics/contact/body/body_triangle.h"

#include "physics/contact/body/body_surface.h"
#include "physics/contact/body/feature_through.h"
#include "physics/contact/body/meeting.h"
#include "physics/contact/moving_collider.h"

namespace weft::physics {
namespace {

using Feature = BodyMoment::Feature;

constexpr double kRests =
    2 *
    AllowedDepth::
        kSlack;  // of an edge; so deep is what rests on the surface, and what may come through it yet
constexpr double kHardly = 0.1;  // of an edge; so deep is no contact that has just begun
constexpr double kReach = 0.25;  // the same: what is deeper is left to the particles

// A point of a triangle, and the point of a feature that is nearest to it.
struct Pair {
  Weights weights{};
  Vec3 on{};
  bool inner = false;  // not a corner of the triangle, which is a particle
};

Pair nearest_to_corner(const Corners& c, const Vec3& corner) {
  const Weights w = nearest_on(c.x, corner);
  return {w, corner, w[0] < 1 && w[1] < 1 && w[2] < 1};
}

// Of the side from corner k on and the segment p … q, where both are between their ends (Ericson, Real-Time
// Collision Detection, 5.1.9).
Pair nearest_to_edge(const Corners& c, std::size_t k, const Vec3& p, const Vec3& q) {
  const std::size_t next = (k + 1) % 3;
  const Vec3 d = minus(c.x[next], c.x[k]), e = minus(q, p), r = minus(c.x[k], p);
  const double dd = dot(d, d), de = dot(d, e), ee = dot(e, e), dr = dot(d, r), er = dot(e, r);
  const double denominator = dd * ee - de * de;
  Pair pair;
  if (!(denominator > 1e-9 * dd * ee)) return pair;
  const double s = (de * er - dr * ee) / denominator, t = (dd * er - de * dr) / denominator;
  pair.inner = s > 0 && s < 1 && t >= 0 && t <= 1;
  pair.weights[k] = 1 - s;
  pair.weights[next] = s;
  pair.on = plus(p, times(e, t));
  return pair;
}

class Search {
 public:
  Search(const BodyPassage& body, const Corners& c, double offset, double edge)
      : body_(body),
        c_(c),
        edge_(std::max(edge, longest_side(c.x))),
        least_(std::max(0.0, -offset)),
        about_(about_triangle(body, c, offset, edge)) {
    found_.nearest.distance = offset;
  }

  DeepestOnBody among_all() {
    const AlignedBox where = about_.box.grown(about_.reach);
    body_.now.features(
        about_.most, [&](int node) { return body_.now.feature_box(node).meets(where); },
        [&](int n) { look(body_.now.form().features[std::size_t(n)]); });
    return found_;
  }
  DeepestOnBody among(std::span<const int> features) {
    for (const int n : features)
      if (body_.now.sticks_out(n, about_.most)) look(body_.now.form().features[std::size_t(n)]);
    return found_;
  }

 private:
  void look(const Feature& f) {
    const Vec3 p = body_.now.vertex(f.a), q = body_.now.vertex(f.b);
    const bool closed = body_.now.closed();
    if (f.a == f.b) {
      if (closed && goes_back(f, corner_through(body_, f, c_, least_), !corner_))
        corner_ = true;
      else
        look(f, nearest_to_corner(c_, p));
      return;
    }
    for (std::size_t k = 0; k < 3 && !corner_; ++k)
      if (!closed || !goes_back(f, edge_through(body_, f, c_, k, least_), false))
        look(f, nearest_to_edge(c_, k, p, q));
  }

  bool goes_back(const Feature& f, const Through& t, bool first) {
    if (!(t.depth > least_) || t.depth > about_.reach) return false;
    if (!first && !(t.depth > -found_.nearest.distance)) return false;
    const bool crossed = t.meets && t.before < kRests * edge_;
    // Of a thin body the feature across from it is none of those about the way out.
    const auto inside = [&] {
      const BodyMoment::Point point = body_.now.nearest(t.behind, f.triangle);
      return point.distance < -t.beside && dot(point.normal, t.outward) > 0;
    };
    if (!crossed && !(t.before < kHardly * edge_ && inside()) && !pierces(f)) return false;
    found_ = {{t.weights, {-t.depth, t.normal}}, t.way};
    return true;
  }

  // Whether two edges of the body from a corner on go through the triangle. Behind the tip of a thin body nothing else
  // may tell: its own sides are nearer than those of the tip.
  bool pierces(const Feature& f) const {
    if (f.a != f.b) return false;
    const Vec3 tip = body_.now.vertex(f.a);
    int first = f.a;
    for (const int n : body_.now.form().at_vertex(f.a))
      for (const int v : body_.now.form().triangles[std::size_t(n)]) {
        if (v == f.a || v == first || meets(tip, body_.now.vertex(v), c_.x).at > 1) continue;
        if (first != f.a) return true;
        first = v;
      }
    return false;
  }

  void look(const Feature& f, const Pair& pair) {
    if (!pair.inner || corner_) return;
    const Vec3 here = c_.at(pair.weights), out = minus(pair.on, here);
    const double square = dot(out, out);
    if (square > about_.reach * about_.reach) return;
    const bool pierces = body_.now.closed() && dot(out, body_.now.outward(f)) > 0;
    const double most = std::max(found_.nearest.distance, 0.0);
    if (body_.now.closed() && !pierces && square > most * most) return;
    const Vec3 before = minus(here, Corners{c_.path, {}}.at(pair.weights));
    int hint = f.triangle;
    const auto nearest = [&](const BodyMoment& moment, const Vec3& at) {
      const BodyMoment::Point point = moment.nearest(at, hint);
      hint = point.triangle;
      return point;
    };
    const BodyMoment::Point point = body_.meet(before, here, nearest).now;
    if (point.distance >= found_.nearest.distance) return;
    found_ = {{pair.weights, {point.distance, point.normal}},
              body_.way(point.triangle, point.weights)};
  }

  const BodyPassage& body_;
  const Corners& c_;
  double edge_;         // m
  const double least_;  // m; what has come through by less may stay
  AboutTriangle about_;
  DeepestOnBody found_;
  bool corner_ = false;  // one has come through, and goes before edges that have come after it
};

}  // namespace

AboutTriangle about_triangle(const BodyPassage& body, const Corners& c, double offset,
                             double edge) {
  const double longest = std::max(edge, longest_side(c.x));
  AboutTriangle about;
  double way = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    about.box.add(c.x[k]);
    way = std::max(way, dot(c.path[k], c.path[k]));
  }
  about.reach = std::max(offset, kReach * longest) + std::sqrt(way) + body.travel;
  about.most = kSmallFeature * longest;
  return about;
}

DeepestOnBody deepest_on(const BodyPassage& body, const Corners& c, double offset, double edge) {
  return Search(body, c, offset, edge).among_all();
}

DeepestOnBody deepest_among(std::span<const int> features, const BodyPassage& body,
                            const Corners& c, double offset, double edge) {
  return Search(body, c, offset, edge).among(features);
}

Deepest deepest_on(const MeshBody& body, const Corners& c, double offset, double edge, double) {
  return deepest_on(BodyPassage::standing(body.surface->at(body.time)), c, offset, edge);
}

}  // namespace weft::physics
