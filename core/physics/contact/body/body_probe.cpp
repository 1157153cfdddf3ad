#include "physics/contact/body/body_probe.h"

#include <cmath>

#include "physics/contact/body/body_surface.h"

namespace weft::physics {
namespace {

constexpr double kMargin = 0.25;   // of the body's mean edge, at most: lists are to be short
constexpr double kMostMargin = 1;  // the same, of a body that moves
constexpr int kHalvings = 2;       // of the margin, where a list would be long
constexpr double kWorn = 0.5;      // of a distance: what is left of it where it is measured again

Vec3 at(ConstRow3 r, int i) {
  return {r.x[i], r.y[i], r.z[i]};
}

double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}

double distance_between(const Vec3& a, const Vec3& b) {
  return length(minus(a, b));
}

void put(Rows& rows, int j, int i, const Vec3& value) {
  for (int k = 0; k < 3; ++k) rows.at(k, j, i) = float(value[std::size_t(k)]);
}

}  // namespace

BodyProbe::BodyProbe(const BodySurface& surface, const Particles& particles)
    : surface_(surface),
      stride_(particles.stride),
      near_(std::size_t(particles.rows) * std::size_t(particles.stride)),
      normal_(particles.rows, particles.stride),
      normal_before_(particles.rows, particles.stride),
      velocity_(surface.moves() ? particles.rows : 0, particles.stride),
      distance_(near_.size()),
      distance_before_(near_.size()) {
  for (int j = 0; j < particles.rows; ++j) {
    const std::size_t first = std::size_t(j) * std::size_t(stride_);
    found_.push_back({distance_.data() + first, normal_.row(j), distance_before_.data() + first,
                      normal_before_.row(j),
                      surface.moves() ? ConstRow3(velocity_.row(j)) : ConstRow3{}});
  }
}

std::size_t BodyProbe::bytes() const {
  return near_.size() * (sizeof(Near) + 2 * sizeof(float)) + normal_.bytes() +
         normal_before_.bytes() + velocity_.bytes();
}

void BodyProbe::look(CollideRow& row, const BodyPassage& body, int j, const Substep& s) {
  for (int i = 0; i < row.columns; ++i)
    if (row.w[i] > 0) look({row, body, s}, j, i);
  row.shape.found = &found_[std::size_t(j)];
}

void BodyProbe::look(const Look& look, int j, int i) {
  const CollideRow& row = look.row;
  const std::size_t lane = std::size_t(j) * std::size_t(stride_) + std::size_t(i);
  Near& near = near_[lane];
  const Vec3 p = minus(at(row.x, i), {row.cx, row.cy, row.cz});
  const Vec3 path = times(minus(at(row.v, i), {row.ux, row.uy, row.uz}), row.dt);
  const double limit = std::max(double(row.offset) + row.bias, length(path) + look.body.travel);
  if (const double apart = near.apart(p, look.s.time); apart <= near.known) {
    constexpr double kRounding = 1 - 1e-6;
    const double least = near.distance - apart - near.loose;
    distance_[lane] = float(least * kRounding);
    if (least > limit) return;
  }
  const Vec3 before = minus(p, path);
  BodyPassage::Meeting m = look.body.meet(before, p, [&](const BodyMoment& moment, const Vec3& q) {
    return nearest(near, look, &moment == &look.body.now, q);
  });
  if (!m.knows_before && row.resolved && m.now.distance < row.offset)
    m.before = nearest(near, look, false, before);
  distance_[lane] = float(m.now.distance);
  distance_before_[lane] = float(m.before.distance);
  put(normal_, j, i, m.now.normal);
  put(normal_before_, j, i, m.before.normal);
  if (look.body.moves())
    put(velocity_, j, i, times(look.body.way(m.now.triangle, m.now.weights), 1 / look.s.dt));
}

double BodyProbe::Near::apart(const Vec3& p, double when) const {
  if (!(when >= begin && when <= end)) return 1e300;
  return distance_between(p, plus(at, times(drift, when - time)));
}

// What is found now is what is kept.
BodyMoment::Point BodyProbe::nearest(Near& near, const Look& look, bool now, const Vec3& p) {
  const BodyMoment& moment = now ? look.body.now : look.body.before;
  const double time = now ? look.s.time : look.s.time - look.s.dt;
  if (near.listed > 0 && 2 * near.apart(p, time) <= near.margin)
    return moment.nearest_among({near.list.data(), std::size_t(near.listed)}, p);
  const BodyMoment::Point point = moment.nearest(p, near.triangle);
  if (!now) return point;
  near.at = p;
  near.time = time;
  near.distance = point.distance;
  near.triangle = point.triangle;
  if (look.body.moves())
    know_moving(near, look, point);
  else
    know_standing(near, look);
  return point;
}

// Far off no list is made: it would be long.
void BodyProbe::know_standing(Near& near, const Look& look) const {
  near.begin = -1e300;
  near.end = 1e300;
  near.listed = 0;
  near.known = (1 - kWorn) * near.distance;
  if (std::abs(near.distance) > surface_.mean_edge()) return;
  near.margin = kMargin * surface_.mean_edge();
  for (int n = 0; n <= kHalvings && near.listed <= 0; ++n) {
    if (n > 0) near.margin /= 2;
    near.listed = look.body.now.within(near.at, std::abs(near.distance) + near.margin, near.list);
  }
}

// Parts that overlap may take turns at being nearest in ways that no list bounds.
void BodyProbe::know_moving(Near& near, const Look& look, const BodyMoment::Point& point) const {
  const BodyMoment& now = look.body.now;
  const bool one_way = look.body.before.on_one_way(now);
  const BodyMoment& begin = one_way ? look.body.before : now;
  const BodyMoment end = now.at_end();
  near.begin = now.form().parts.size() > 1 ? 1e300 : look.s.time - (one_way ? look.s.dt : 0);
  near.end = now.end();
  const double left = near.end - near.begin;
  const Vec3 way =
      minus(end.on(point.triangle, point.weights), begin.on(point.triangle, point.weights));
  near.drift = left < 1e100 ? times(way, 1 / left) : Vec3{};
  const Vec3 from = plus(near.at, times(near.drift, near.begin - near.time));
  const double strayed = strays(begin, end, way, point.triangle);
  const double far = (1 - kWorn) * near.distance;
  near.margin = std::clamp(far, kMargin * surface_.mean_edge(), kMostMargin * surface_.mean_edge());
  near.known = near.margin / 2;
  near.listed =
      within_between(begin, end, from, plus(from, way),
                     std::abs(near.distance) + 2 * strayed + near.margin, near.list, near.loose);
}

}  // namespace weft::physics
