// x = x(t₀) + (t - t₀) u, v = u for every particle that is held.
#include "physics/frame/carry.h"

#include <cmath>

#include "physics/contact/colliders/shapes.h"

namespace weft::physics {

void Carry::begin(double time, const Vec3& velocity) {
  if (!by_row_.empty() && velocity == velocity_) return;
  time_ = time;
  velocity_ = velocity;
  const Lattice& l = parts_.lattice;
  by_row_.assign(std::size_t(l.rows), {});
  for (int j = 0; j < l.rows; ++j)
    for (int i = 0; i < l.columns; ++i)
      if (l.w(j, i) == 0)
        by_row_[std::size_t(j)].push_back({i, {l.x.at(0, j, i), l.x.at(1, j, i), l.x.at(2, j, i)}});
}

double Carry::speed() const {
  return std::sqrt(dot(velocity_, velocity_));
}

void Carry::run(int j, const Substep& s) {
  Lattice& l = parts_.lattice;
  for (const Held& held : by_row_[std::size_t(j)]) {
    if (l.w(j, held.column) > 0) continue;  // let go since
    for (int k = 0; k < 3; ++k) {
      l.x.at(k, j, held.column) = coordinate(held.start[k] + (s.time - time_) * velocity_[k]);
      l.v.at(k, j, held.column) = float(velocity_[k]);
    }
  }
}

}  // namespace weft::physics
