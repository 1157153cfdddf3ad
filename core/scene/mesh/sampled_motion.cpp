#include "scene/mesh/sampled_motion.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace weft::text {
namespace {

constexpr float kLeastStep = 1e-4F;  // s

using Places = std::vector<Vec3>;
using At = std::function<Places(double)>;

struct Interval {
  float begin, end;
  double off;
  // The worst on top; of equals the first.
  bool operator<(const Interval& other) const {
    return off != other.off ? off < other.off : begin > other.begin;
  }
  float middle() const { return begin + (end - begin) / 2; }
  bool divides() const { return middle() - begin >= kLeastStep && end - middle() >= kLeastStep; }
};

// How far points that go straight come from their ways.
double distance_off(float begin, float end, const Places& from, const Places& to, const At& at) {
  double most = 0;
  for (const double share : {0.25, 0.5, 0.75}) {
    const Places now = at(double(begin) + share * (double(end) - double(begin)));
    for (std::size_t p = 0; p < now.size(); ++p) {
      double square = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double off = now[p][k] - ((1 - share) * from[p][k] + share * to[p][k]);
        square += off * off;
      }
      most = std::max(most, square);
    }
  }
  return std::sqrt(most);
}

}  // namespace

SampledMotion choose_samples(std::vector<double> knots, double tolerance, std::size_t most,
                             const At& at) {
  SampledMotion motion;
  std::sort(knots.begin(), knots.end());
  for (const double knot : knots) {
    const float time = float(knot);
    if (motion.times.empty() || time - motion.times.back() >= kLeastStep)
      motion.times.push_back(time);
  }
  // The motion ends where the last knot says.
  if (const float last = float(knots.back()); motion.times.back() != last)
    motion.times.size() > 1 ? void(motion.times.back() = last) : motion.times.push_back(last);
  if (motion.times.size() > most) return motion;
  std::priority_queue<Interval> open;
  Places from = at(double(motion.times[0]));
  for (std::size_t n = 1; n < motion.times.size(); ++n) {
    Places to = at(double(motion.times[n]));
    const float begin = motion.times[n - 1], end = motion.times[n];
    open.push({begin, end, distance_off(begin, end, from, to, at)});
    from = std::move(to);
  }
  while (!open.empty() && open.top().off > tolerance) {
    const Interval worst = open.top();
    open.pop();
    if (!worst.divides() || motion.times.size() >= most) {
      motion.off = std::max(motion.off, worst.off);
      continue;
    }
    const float middle = worst.middle();
    const Places a = at(double(worst.begin)), b = at(double(middle)), c = at(double(worst.end));
    motion.times.push_back(middle);
    open.push({worst.begin, middle, distance_off(worst.begin, middle, a, b, at)});
    open.push({middle, worst.end, distance_off(middle, worst.end, b, c, at)});
  }
  if (!open.empty()) motion.off = std::max(motion.off, open.top().off);
  std::sort(motion.times.begin(), motion.times.end());
  return motion;
}

}  // namespace weft::text
