// Distances from the surface of a body (body_moment.h).
#include "physics/contact/body/body_moment.h"

#include <cmath>

namespace weft::physics {
namespace {

constexpr double kTouching = 1e-10;  // m; nearer points have no direction of their own

// What is near to a place that is no number: the first triangle, as far off as can be.
constexpr BodyMoment::Point kNothingNear{1e300, {}, 0, {1, 0, 0}};

}  // namespace

Vec3 BodyMoment::face_normal(int triangle) const {
  if (!moves()) return from_->face_normals[std::size_t(triangle)];
  const Triangle t = corners(triangle);
  return unit(normal_of(t[0], t[1], t[2]));
}

Vec3 BodyMoment::vertex_normal(int vertex) const {
  if (!from_->vertex_normals.empty()) return from_->vertex_normals[std::size_t(vertex)];
  return normal_at(
      *form_, vertex, [&](int n) { return corners(n); }, [&](int n) { return face_normal(n); });
}

Vec3 BodyMoment::outward(const Feature& feature) const {
  if (feature.a == feature.b) return vertex_normal(feature.a);
  const Vec3 own = face_normal(feature.triangle);
  return feature.other < 0 ? own : unit(plus(own, face_normal(feature.other)));
}

void BodyMoment::look_at(int triangle, const Vec3& p, Candidate& best) const {
  const Triangle t = corners(triangle);
  const Weights w = nearest_on(t, p);
  const Vec3 d = minus(p, plus(plus(times(t[0], w[0]), times(t[1], w[1])), times(t[2], w[2])));
  const double square = dot(d, d);
  if (square > best.square || (square == best.square && triangle >= best.triangle)) return;
  best = {square, triangle, w};
}

// On a face, an edge or a corner, as the weights say.
BodyMoment::Point BodyMoment::point_of(const Candidate& c, const Vec3& p) const {
  const auto n = std::size_t(c.triangle);
  const Weights& w = c.weights;
  const Vec3 d = minus(p, on(c.triangle, w));
  const int held = (w[0] != 0) + (w[1] != 0) + (w[2] != 0);
  Vec3 normal;
  if (held == 1)
    normal = vertex_normal(form_->triangles[n][w[0] != 0 ? 0 : w[1] != 0 ? 1 : 2]);
  else
    normal = face_normal(c.triangle);
  if (held == 2)
    if (const int other = form_->beside[n][w[2] == 0 ? 0 : w[0] == 0 ? 1 : 2]; other >= 0)
      normal = plus(normal, face_normal(other));
  const double apart = length(d), side = dot(d, normal) < 0 ? -1 : 1;
  const Vec3 unit = held < 3 && apart > kTouching
                        ? times(d, (closed() ? side : 1) / apart)
                        : times(normal, (closed() ? 1 : side) / std::max(length(normal), 1e-300));
  return {closed() ? side * apart : apart, unit, c.triangle, w};
}

BodyMoment::Point BodyMoment::nearest_in(std::size_t number, const Vec3& p, int hint,
                                         double enough) const {
  const BodyForm::Part& part = form_->parts[number];
  Candidate best;
  best.square = enough;
  look_at(hint >= part.first && hint < part.last ? hint : part.first, p, best);
  part.tree.nearest([&](int node) { return part_box(number, node).square_from(p); }, best.square,
                    [&](int n) { look_at(part.first + n, p, best); });
  return best.triangle < 0 ? kNothingNear : point_of(best, p);
}

BodyMoment::Point BodyMoment::nearest(const Vec3& p, int hint) const {
  Point best = kNothingNear;
  for (std::size_t part = 0; part < form_->parts.size(); ++part) {
    const double square = part_box(part, 0).square_from(p);
    const double most = best.distance > 0 ? best.distance * best.distance : 0;
    // What p is outside of can only be nearer.
    if (square > most) continue;
    const Point one = nearest_in(part, p, hint, square > 0 ? most : 1e300);
    if (one.distance < best.distance) best = one;
  }
  return best;
}

BodyMoment::Point BodyMoment::nearest_among(std::span<const int> triangles, const Vec3& p) const {
  const std::vector<BodyForm::Part>& parts = form_->parts;
  Point best = kNothingNear;
  for (std::size_t n = 0; n < triangles.size();) {
    const int first = triangles[n];
    const int last =
        parts.size() == 1
            ? parts[0].last
            : std::upper_bound(parts.begin(), parts.end(), first,
                               [](int t, const BodyForm::Part& part) { return t < part.last; })
                  ->last;
    Candidate nearest;
    for (; n < triangles.size() && triangles[n] < last; ++n) look_at(triangles[n], p, nearest);
    if (nearest.triangle < 0) continue;
    const Point one = point_of(nearest, p);
    if (one.distance < best.distance) best = one;
  }
  return best;
}

bool BodyMoment::within_part(std::size_t part, const Vec3& p) const {
  return part_box(part, 0).square_from(p) <= 0 && nearest_in(part, p, 0, 1e300).distance < 0;
}

}  // namespace weft::physics
