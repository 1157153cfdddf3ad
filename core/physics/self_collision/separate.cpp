// Self-collision (self_collision.h): pairs pushed apart, chunk by chunk (kernels/separate.cpp).
#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/self_collision/self_collision.h"

namespace weft::physics {
namespace {

constexpr int kIterations = 3;        // of pushing apart, in one run
constexpr float kClose = 1.15f;       // distances at which two are held: may touch in this run
constexpr std::size_t kPadding = 32;  // that kernels may write

}  // namespace

void SelfContact::gather(std::size_t chunk) {
  for (std::size_t a = search_.begin(chunk); a < search_.begin(chunk + 1); ++a) {
    if (search_.counts()[a] == 0) continue;
    const Site s = search_.site(a);
    const Sheet& sheet = sheets_[s.cloth];
    Lattice& l = *sheet.lattice;
    const Row3 x = l.x.row(s.row), v = l.v.row(s.row);
    const float held = sheet.course ? sheet.thickness : sheet.thickness * kHeld;
    bodies_[a] = {{x.x[s.column], x.y[s.column], x.z[s.column], held},
                  {v.x[s.column], v.y[s.column], v.z[s.column], l.w(s.row, s.column)}};
    friction_[a] = sheet.course ? kCourseRule : sheet.friction;
  }
}

void SelfContact::scatter(std::size_t chunk) {
  for (std::size_t a = search_.begin(chunk); a < search_.begin(chunk + 1); ++a) {
    const Body b = bodies_[a];
    if (search_.counts()[a] == 0 || b.v[3] <= 0) continue;
    const Site s = search_.site(a);
    Lattice& l = *sheets_[s.cloth].lattice;
    const Row3 x = l.x.row(s.row), v = l.v.row(s.row);
    x.x[s.column] = b.x[0], x.y[s.column] = b.x[1], x.z[s.column] = b.x[2];
    v.x[s.column] = b.v[0], v.y[s.column] = b.v[1], v.z[s.column] = b.v[2];
  }
}

// The pairs that are pushed apart now, or that others may push into each other.
void SelfContact::list_close(std::size_t chunk) {
  const PairSearch::Pairs pairs = search_.pairs(chunk);
  Close& close = close_[chunk];
  close.count =
      kernels_.pairs_within({bodies_.data(), int(pairs.count), pairs.owner, pairs.neighbour, kClose,
                             close.owner.data(), close.neighbour.data()});
}

// Makes room.
void SelfContact::begin_response(Threads& threads) {
  const auto grown = [](auto& list, std::size_t count) {
    if (list.owner.size() >= count + kPadding) return false;
    list.owner.resize(2 * count + kPadding);
    list.neighbour.resize(list.owner.size());
    return true;
  };
  speeds_.resize(search_.chunks());
  if (close_.size() < search_.chunks()) close_.resize(search_.chunks());
  std::size_t most = 0;
  for (std::size_t k = 0; k < search_.chunks(); ++k) {
    grown(close_[k], search_.pairs(k).count);
    most = std::max(most, search_.pairs(k).count);
  }
  rooms_.resize(std::size_t(threads.count()));
  for (Room& r : rooms_)
    if (grown(r, most)) r.asked.resize(r.owner.size());
}

double SelfContact::respond(double dt, int since, Threads& threads) {
  if (found_ == 0) return 0;
  begin_response(threads);
  const bool alone = few_pairs() || threads.count() == 1;
  const auto each = [&](auto&& work) { threads.share(search_.chunks(), alone, work); };
  each([&](std::size_t k) { gather(k); });
  // The course's push for as many substeps as have passed.
  const double steps = scene_.time.substeps > 0 ? scene_.time.substeps : scene_.time.frame / dt;
  const int iterations = course_ ? 1 : kIterations;
  for (int i = 0; i < iterations; ++i) {
    each([&](std::size_t k) {
      if (i == 0) list_close(k);
      Room& room = rooms_[alone ? 0 : std::size_t(Threads::index())];
      const Close& close = close_[k];
      speeds_[k] =
          kernels_.separate({bodies_.data(),
                             int(search_.begin(k)),
                             int(search_.begin(k + 1)),
                             close.count,
                             close.owner.data(),
                             close.neighbour.data(),
                             friction_.data(),
                             float(since / steps),
                             float(1 / dt),
                             separated_.data(),
                             {room.owner.data(), room.neighbour.data(), room.asked.data()}});
    });
    std::swap(bodies_, separated_);
  }
  each([&](std::size_t k) { scatter(k); });
  return std::sqrt(*std::max_element(speeds_.begin(), speeds_.end()));
}

}  // namespace weft::physics
