#include "physics/contact/body/body_probe.h"

#include <cmath>

namespace weft::physics {
namespace {

constexpr double kMargin = 0.25;  // of the body's mean edge, at most: lists are to be short
constexpr int kHalvings = 2;      // of the margin, where a list would be long
constexpr double kWorn = 0.5;     // of a distance: what is left of it where it is measured again

Vec3 at(ConstRow3 r, int i) {
  return {r.x[i], r.y[i], r.z[i]};
}

double distance_between(const Vec3& a, const Vec3& b) {
  const Vec3 d = minus(a, b);
  return std::sqrt(dot(d, d));
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
      distance_(near_.size()),
      distance_before_(near_.size()) {
  for (int j = 0; j < particles.rows; ++j) {
    const std::size_t first = std::size_t(j) * std::size_t(stride_);
    found_.push_back({distance_.data() + first, normal_.row(j), distance_before_.data() + first,
                      normal_before_.row(j)});
  }
}

std::size_t BodyProbe::bytes() const {
  return near_.size() * (sizeof(Near) + 2 * sizeof(float)) + normal_.bytes() +
         normal_before_.bytes();
}

void BodyProbe::look(CollideRow& row, int j) {
  for (int i = 0; i < row.columns; ++i)
    if (row.w[i] > 0) look(row, j, i);
  row.shape.found = &found_[std::size_t(j)];
}

void BodyProbe::look(const CollideRow& row, int j, int i) {
  const std::size_t lane = std::size_t(j) * std::size_t(stride_) + std::size_t(i);
  Near& near = near_[lane];
  const Vec3 p = minus(at(row.x, i), {row.cx, row.cy, row.cz});
  const Vec3 path = times(minus(at(row.v, i), {row.ux, row.uy, row.uz}), row.dt);
  const double limit = std::max(double(row.offset) + row.bias, std::sqrt(dot(path, path)));
  if (const double least = near.distance - distance_between(p, near.at);
      least > limit && least > kWorn * near.distance) {
    constexpr double kRounding = 1 - 1e-6;
    distance_[lane] = float(least * kRounding);
    return;
  }
  const Vec3 before = minus(p, path);
  BodySurface::Meeting m =
      surface_.meet(before, p, [&](const Vec3& q, bool now) { return nearest(near, q, now); });
  if (!m.knows_before && row.resolved && m.now.distance < row.offset)
    m.before = nearest(near, before, false);
  distance_[lane] = float(m.now.distance);
  distance_before_[lane] = float(m.before.distance);
  put(normal_, j, i, m.now.normal);
  put(normal_before_, j, i, m.before.normal);
}

BodySurface::Point BodyProbe::nearest(Near& near, const Vec3& p, bool keep) {
  if (near.listed > 0 && 2 * distance_between(p, near.at) <= near.margin)
    return surface_.nearest_among({near.list.data(), std::size_t(near.listed)}, p);
  const BodySurface::Point point = surface_.nearest(p, near.triangle);
  if (!keep) return point;
  near.at = p;
  near.distance = point.distance;
  near.triangle = point.triangle;
  near.listed = 0;
  if (std::abs(point.distance) > surface_.mean_edge()) return point;
  near.margin = kMargin * surface_.mean_edge();
  for (int n = 0; n <= kHalvings && near.listed <= 0; ++n) {
    if (n > 0) near.margin /= 2;
    near.listed = surface_.within(p, std::abs(point.distance) + near.margin, near.list);
  }
  return point;
}

}  // namespace weft::physics
