// Self-collision (self_collision.h): pairs pushed apart, group by group (kernels/separate.cpp).
#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/self_collision/self_collision.h"

namespace weft::physics {
namespace {

constexpr int kIterations = 3;                                    // of pushing apart, in one run
constexpr std::size_t kGroups = 32;                               // of a task
constexpr std::size_t kFewGroups = 64;                            // that one thread does faster
constexpr Body kFarAway{{1e18f, 1e18f, 1e18f, 0}, {0, 0, 0, 0}};  // its square is still finite

}  // namespace

void SelfContact::gather(std::size_t group) {
  for (std::size_t a = 16 * group; a < 16 * group + 16; ++a) {
    Body& b = bodies_[a];
    if (a >= pairs_.site.size()) {
      b = kFarAway;
      continue;
    }
    const Site& s = pairs_.site[a];
    const Sheet& sheet = sheets_[s.cloth];
    const Lattice& l = *sheet.lattice;
    for (int k = 0; k < 3; ++k) {
      b.x[k] = l.x.at(k, s.row, s.column);
      b.v[k] = l.v.at(k, s.row, s.column);
    }
    b.v[3] = l.w(s.row, s.column);
    b.x[3] = sheet.thickness;
  }
}

void SelfContact::scatter(std::size_t group) {
  for (std::size_t a = 16 * group; a < std::min(16 * group + 16, pairs_.site.size()); ++a) {
    const Body& b = bodies_[a];
    if (b.v[3] <= 0) continue;
    const Site& s = pairs_.site[a];
    Lattice& l = *sheets_[s.cloth].lattice;
    for (int k = 0; k < 3; ++k) {
      l.x.at(k, s.row, s.column) = b.x[k];
      l.v.at(k, s.row, s.column) = b.v[k];
    }
  }
}

double SelfContact::respond(double dt, int since, Threads& threads) {
  if (pairs_.site.empty()) return 0;
  const std::size_t n = groups();
  bodies_.resize(16 * n + 16, kFarAway);
  separated_.resize(16 * n + 16, kFarAway);
  for (std::size_t a = 16 * n; a < 16 * n + 16; ++a) bodies_[a] = separated_[a] = kFarAway;
  speeds_.resize(n);
  const auto each = [&](auto&& work) {
    threads.share((n + kGroups - 1) / kGroups, n < kFewGroups, [&](std::size_t k) {
      for (std::size_t g = k * kGroups; g < std::min(n, (k + 1) * kGroups); ++g) work(g);
    });
  };
  each([&](std::size_t g) { gather(g); });
  // The course's push for as many substeps as have passed.
  const double steps = scene_.time.substeps > 0 ? scene_.time.substeps : scene_.time.frame / dt;
  const int iterations = course_ ? 1 : kIterations;
  for (int i = 0; i < iterations; ++i) {
    each([&](std::size_t g) {
      const auto first = int(16 * g);
      speeds_[g] =
          kernels_.separate({bodies_.data(), first, int(slots_.first[g + 1] - slots_.first[g]),
                             slots_.neighbour.data() + 16 * slots_.first[g],
                             slots_.friction.data() + first, slots_.course.data() + first,
                             float(since / steps), float(1 / dt), separated_.data() + first});
    });
    std::swap(bodies_, separated_);
  }
  each([&](std::size_t g) { scatter(g); });
  return std::sqrt(*std::max_element(speeds_.begin(), speeds_.end()));
}

}  // namespace weft::physics
