// x = x(t₀) + (t - t₀) u, v = u for every particle that is held.
#include "physics/frame/carry.h"

#include <cmath>

#include "physics/contact/colliders/shapes.h"
#include "physics/step/keeper.h"

namespace weft::physics {

void Carry::begin(double time, const Vec3& velocity) {
  if (!by_row_.empty() && velocity == velocity_) return;
  velocity_ = velocity;
  begin_anew(time);
}

void Carry::begin_anew(double time) {
  time_ = time;
  const Particles& p = parts_.particles;
  by_row_.assign(std::size_t(p.rows), {});
  p.for_each([&](int j, int i) {
    if (p.w(j, i) == 0) by_row_[std::size_t(j)].push_back({i, p.position(j, i)});
  });
}

void Carry::keep(Keeper& keeper) {
  keeper(by_row_);
  keeper(time_);
  keeper(velocity_);
}

double Carry::speed() const {
  return length(velocity_);
}

void Carry::run(int j, const Substep& s) {
  Particles& l = parts_.particles;
  for (const Held& held : by_row_[std::size_t(j)]) {
    if (l.w(j, held.lane) > 0) continue;  // let go since
    for (int k = 0; k < 3; ++k) {
      l.x.at(k, j, held.lane) = coordinate(held.start[k] + (s.time - time_) * velocity_[k]);
      l.v.at(k, j, held.lane) = float(velocity_[k]);
    }
  }
}

}  // namespace weft::physics
