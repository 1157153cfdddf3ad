// Pins that move (held.h).
#include "held.h"

#include <cmath>
#include <numbers>

namespace bench {
namespace {

double dot(const weft::Vec3& a, const weft::Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double degrees_at(const std::vector<weft::Angle>& keys, double time) {
  if (time <= keys.front().time) return keys.front().degrees;
  for (std::size_t n = 1; n < keys.size(); ++n)
    if (time < keys[n].time) {
      const double s = (time - keys[n - 1].time) / (keys[n].time - keys[n - 1].time);
      return (1 - s) * keys[n - 1].degrees + s * keys[n].degrees;
    }
  return keys.back().degrees;
}

// Rodrigues' formula.
weft::Vec3 turned(const weft::Vec3& x, const weft::Rotation& rotation, double radians) {
  const weft::Vec3& a = rotation.axis;
  const double length = std::sqrt(dot(a, a)), c = std::cos(radians), s = std::sin(radians);
  weft::Vec3 r, k;
  for (std::size_t n = 0; n < 3; ++n) r[n] = x[n] - rotation.about[n], k[n] = a[n] / length;
  const double along = dot(k, r) * (1 - c);
  weft::Vec3 place;
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t p = (n + 1) % 3, q = (n + 2) % 3;
    place[n] = rotation.about[n] + c * r[n] + s * (k[p] * r[q] - k[q] * r[p]) + along * k[n];
  }
  return place;
}

}  // namespace

std::vector<Held> moving_pins(const weft::Cloth& cloth) {
  std::vector<Held> all;
  for (const weft::Pin& pin : cloth.pins)
    if (pin.moves())
      all.push_back({std::size_t(weft::particle_number(cloth.grid, pin.i, pin.j)),
                     weft::place_on(cloth.grid, pin.i, pin.j), pin});
  return all;
}

weft::Vec3 place_of(const Held& held, double time) {
  const weft::Pin& pin = held.pin;
  const weft::Vec3 at = pin.keys.empty() ? held.start : weft::position_at(pin.keys, time);
  if (pin.rotate.keys.empty()) return at;
  return turned(at, pin.rotate, degrees_at(pin.rotate.keys, time) * std::numbers::pi / 180);
}

}  // namespace bench
