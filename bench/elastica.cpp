// The elastica (elastica.h).
#include "elastica.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace bench {
namespace {

// Angle below the level, moment D λ² θ', and place.
using State = std::array<double, 4>;

constexpr int kSteps =
    4000;  // of Runge and Kutta's fourth order along the strip: far below 1e-9 of its length

// The stretch where C (λ³ - λ)/2 + M²/(D λ³) = pull, the force along the tangent, by Newton from 1.
double stretch_of(const Strip& strip, double moment, double pull) {
  double l = 1;
  for (double change = 1; std::abs(change) > 1e-14;) {
    const double bent = moment * moment / strip.rigidity / (l * l * l);
    const double f = strip.stretch * (l * l * l - l) / 2 + bent - pull;
    const double slope = strip.stretch * (3 * l * l - 1) / 2 - 3 * bent / l;
    change = f / slope;
    l -= change;
  }
  return l;
}

State slope_of(const Strip& strip, double s, const State& y) {
  const double force = strip.weight * (strip.length - s);
  const double c = std::cos(y[0]), sine = std::sin(y[0]);
  const double l = stretch_of(strip, y[1], force * sine);
  return {y[1] / (strip.rigidity * l * l), -l * force * c, l * c, -l * sine};
}

State step(const Strip& strip, double s, double h, const State& y) {
  const auto off = [&](const State& k, double by) {
    State moved = y;
    for (std::size_t n = 0; n < 4; ++n) moved[n] += by * k[n];
    return moved;
  };
  const State a = slope_of(strip, s, y), b = slope_of(strip, s + h / 2, off(a, h / 2)),
              c = slope_of(strip, s + h / 2, off(b, h / 2)), d = slope_of(strip, s + h, off(c, h));
  State next = y;
  for (std::size_t n = 0; n < 4; ++n) next[n] += h / 6 * (a[n] + 2 * b[n] + 2 * c[n] + d[n]);
  return next;
}

// Whether the weight is too little for this moment of the root: the strip stands below the level everywhere and
// above the plumb, and bears no moment at its end.
bool too_great(const Strip& strip, double root) {
  State y{0, root, 0, 0};
  const double h = strip.length / kSteps;
  for (int n = 0; n < kSteps; ++n) {
    y = step(strip, n * h, h, y);
    if (y[0] < 0) return false;
    if (y[0] > std::numbers::pi / 2) return true;
  }
  return y[1] > 0;
}

}  // namespace

std::vector<StripPoint> strip_at_rest(const Strip& strip, const std::vector<double>& s) {
  // The root bears at most the weight at half the length's arm.
  double low = 0, high = strip.weight * strip.length * strip.length;
  for (int n = 0; n < 60; ++n) {
    const double middle = (low + high) / 2;
    (too_great(strip, middle) ? high : low) = middle;
  }
  std::vector<StripPoint> all;
  State y{0, (low + high) / 2, 0, 0};
  double at = 0;
  for (const double next : s) {
    if (next <= 0) {
      all.push_back({next, 0});
      continue;
    }
    const int steps = std::max(1, int(std::ceil((next - at) / strip.length * kSteps)));
    const double h = (next - at) / steps;
    for (int n = 0; n < steps; ++n) y = step(strip, at + n * h, h, y);
    at = next;
    all.push_back({y[2], y[3]});
  }
  return all;
}

}  // namespace bench
