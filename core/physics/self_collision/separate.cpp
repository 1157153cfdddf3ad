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

// Once a search: without branches, as who has pairs cannot be foretold.
void SelfContact::list_owners(std::size_t chunk) {
  std::size_t end = search_.begin(chunk);
  for (std::size_t a = search_.begin(chunk); a < search_.begin(chunk + 1); ++a) {
    const Site s = search_.site(a);
    const Sheet& sheet = sheets_[s.cloth];
    const auto stride = std::size_t(sheet.lattice->stride);
    friction_[a] = sheet.course ? kCourseRule : sheet.friction;
    owners_[end] = {std::int32_t(a), s.cloth, s.row * stride + s.column};
    end += search_.counts()[a] > 0;
  }
  owners_end_[chunk] = end;
}

void SelfContact::gather(std::size_t chunk) {
  for (std::size_t k = search_.begin(chunk); k < owners_end_[chunk]; ++k) {
    const Owner o = owners_[k];
    const Sheet& sheet = sheets_[o.sheet];
    Lattice& l = *sheet.lattice;
    const Row3 x = l.x.row(0), v = l.v.row(0);
    const auto a = std::size_t(o.number), i = o.offset;
    const float held = sheet.course ? sheet.thickness : sheet.thickness * kHeld;
    bodies_[a] = {{x.x[i], x.y[i], x.z[i], held}, {v.x[i], v.y[i], v.z[i], l.inverse_mass[i]}};
  }
}

void SelfContact::scatter(std::size_t chunk) {
  for (std::size_t k = search_.begin(chunk); k < owners_end_[chunk]; ++k) {
    const Owner o = owners_[k];
    const Body& b = bodies_[std::size_t(o.number)];
    if (b.v[3] <= 0) continue;
    const std::size_t i = o.offset;
    Lattice& l = *sheets_[o.sheet].lattice;
    const Row3 x = l.x.row(0), v = l.v.row(0);
    x.x[i] = b.x[0], x.y[i] = b.x[1], x.z[i] = b.x[2];
    v.x[i] = b.v[0], v.y[i] = b.v[1], v.z[i] = b.v[2];
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
