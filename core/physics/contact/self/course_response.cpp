// Self-contact (self_contact.h), response `course`: the course's own rule. Of two particles that are too
// near each is to move all of the way that is missing; a particle moves by the mean of what all its pairs
// ask for, a substep's share of it, and its velocity goes along, since the position before stays. (Seeds
// 001 and 004.) It keeps neither momentum nor energy.
#include <algorithm>
#include <cmath>

#include "physics/contact/self/self_contact.h"

namespace weft::physics {
namespace {

constexpr float kTiny = 1e-12f;  // m

}  // namespace

// Whether two push as neighbours on the grid, and do not touch otherwise.
bool SelfContact::only_neighbours(const Site& a, const Site& b) const {
  const Sheet& sheet = sheets_[a.cloth];
  return a.cloth == b.cloth && sheet.response == SelfCollisionResponse::neighbours &&
         sheet.neighbours(b.column - a.column, b.row - a.row);
}

bool SelfContact::by_course(std::int32_t a, std::int32_t b) const {
  const Site one = site(a), other = site(b);
  const auto whole = [&](const Site& s) {
    return sheets_[s.cloth].response == SelfCollisionResponse::course;
  };
  return (whole(one) && whole(other)) || only_neighbours(one, other);
}

// `steps`: substeps of the interval, `dt` their length [s]. Returns how many particles were pushed.
std::size_t SelfContact::push_by_course(double dt, int steps) {
  const double substeps = scene_.time.substeps > 0 ? scene_.time.substeps : scene_.time.frame / dt;
  const float share = float(steps / substeps);
  asked_.resize(bodies_);
  std::vector<std::int32_t> bodies;
  const auto ask = [&](std::int32_t body, const float(&by)[3], float sign) {
    Displacement& sum = asked_[std::size_t(body)];
    if (sum.u[3] == 0) bodies.push_back(body);
    for (int k = 0; k < 3; ++k) sum.u[k] += sign * by[k];
    sum.u[3] += 1;
  };
  for (const PairList& pairs : meeting_)
    for (std::size_t i = 0; i < std::size_t(pairs.count); ++i) {
      const auto [a, b] = std::minmax(pairs.owner[i], pairs.neighbour[i]);
      if (!by_course(a, b)) continue;
      float off[3], square = 0;
      for (int k = 0; k < 3; ++k) {
        off[k] = now_[std::size_t(a)].x[k] - now_[std::size_t(b)].x[k];
        square += off[k] * off[k];
      }
      const float apart =
          0.5f * (sheets_[site(a).cloth].thickness + sheets_[site(b).cloth].thickness);
      const float distance = std::sqrt(square);
      if (!(distance < apart)) continue;
      // In one place: apart along y.
      float by[3] = {0, apart, 0};
      if (distance > kTiny)
        for (int k = 0; k < 3; ++k) by[k] = off[k] * ((apart - distance) / distance);
      ask(a, by, 1);
      ask(b, by, -1);
    }
  for (const std::int32_t body : bodies) {
    Displacement& sum = asked_[std::size_t(body)];
    const Site s = site(body);
    Particles& l = *sheets_[s.cloth].points;  // of grids alone
    for (int k = 0; k < 3 && l.w(s.row, s.column) > 0; ++k) {
      const float by = sum.u[k] / sum.u[3] * share;
      float& x = l.x.at(k, s.row, s.column);
      x += by;
      l.v.at(k, s.row, s.column) += by * float(1 / dt);
      now_[std::size_t(body)].x[k] = x;
    }
    sum = {};
  }
  return bodies.size();
}

}  // namespace weft::physics
