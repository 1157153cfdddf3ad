// Self-collision (self_collision.h): pairs pushed apart, chunk by chunk (kernels/separate.cpp).
#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/self_collision/self_collision.h"

namespace weft::physics {
namespace {

constexpr int kIterations = 3;        // of pushing apart, in one run
constexpr float kClose = 1.1f;        // distances at which two are held: may touch in this run
constexpr float kAdvance = 0.5f;      // BodyBlock
constexpr std::size_t kPadding = 32;  // that kernels may write

}  // namespace

BodyBlock SelfContact::bodies_of(const Block& block, double since) {
  const auto sheet = std::size_t(block.sheet);
  Lattice& l = *sheets_[sheet].lattice;
  BodyBlock b{};
  b.columns = block.columns;
  b.rows = block.rows;
  b.stride = l.stride;
  b.body_stride = named_[sheet].stride;
  b.x = first_of(block, l.x);
  b.v = first_of(block, l.v);
  b.w = l.w(block.row) + block.column;
  b.held = sheets_[sheet].thickness * (sheets_[sheet].course ? 1 : kHeld);
  const std::size_t first = body(sheet, block.row, block.column);
  b.place = place_.data() + first;
  b.motion = motion_.data() + first;
  b.load = first_of(block, load_[sheet]);
  b.ahead = first_of(block, ahead_[sheet]);
  b.since = float(since);
  b.inverse_since = float(1 / since);
  b.advance = sheets_[sheet].course ? 0 : kAdvance;
  return b;
}

// The pairs that touch go into the room; `anew`, those are chosen that others may push into each other
// in this run. Returns how many touch.
int SelfContact::list_close(std::size_t chunk, bool anew, Room& room) {
  Close& close = close_[chunk];
  ClosePairs p{};
  p.place = place_.data();
  p.reach = kClose;
  p.touching = {room.owner.data(), room.neighbour.data()};
  if (!anew) {
    p.pairs = close.count;
    p.owner = close.owner.data();
    p.neighbour = close.neighbour.data();
    return kernels_.close_pairs(p).touching;
  }
  const PairSearch::Pairs pairs = search_.pairs(chunk);
  p.pairs = int(pairs.count);
  p.owner = pairs.owner;
  p.neighbour = pairs.neighbour;
  p.close = {close.owner.data(), close.neighbour.data()};
  const CloseFound found = kernels_.close_pairs(p);
  close.count = found.close;
  return found.touching;
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
    if (close_[k].sum.empty()) {
      close_[k].sum.resize(PairSearch::kChunk);
      close_[k].asked_owner.resize(PairSearch::kChunk);
    }
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
  const auto each_chunk = [&](auto&& work) { threads.share(search_.chunks(), alone, work); };
  const auto each_block = [&](auto kernel) {
    threads.share(blocks_.all().size(), alone, [&](std::size_t b) {
      if (blocks_.all()[b].active) kernel(bodies_of(blocks_.all()[b], since * dt));
    });
  };
  each_block(kernels_.gather_bodies);
  // The course's push for as many substeps as have passed.
  const double steps = scene_.time.substeps > 0 ? scene_.time.substeps : scene_.time.frame / dt;
  const BodyFriction friction{friction_.empty() ? nullptr : friction_.data(), friction_alike_};
  const int iterations = course_ ? 1 : kIterations;
  for (int i = 0; i < iterations; ++i) {
    each_chunk([&](std::size_t k) {
      Room& room = rooms_[alone ? 0 : std::size_t(Threads::index())];
      Close& close = close_[k];
      const int touching = list_close(k, i == 0, room);
      const AskFound asked = kernels_.ask_pairs(
          {place_.data(), motion_.data(), friction, touching, room.owner.data(),
           room.neighbour.data(), room.asked.data(), close.asked_owner.data(), close.sum.data()});
      close.asked_owners = asked.owners;
      speeds_[k] = asked.fastest;
    });
    each_chunk([&](std::size_t k) {
      const Close& close = close_[k];
      kernels_.move_owners({place_.data(), motion_.data(), friction, close.asked_owners,
                            close.asked_owner.data(), close.sum.data(), float(since / steps),
                            float(1 / dt)});
    });
  }
  each_block(kernels_.scatter_bodies);
  return std::sqrt(*std::max_element(speeds_.begin(), speeds_.end()));
}

}  // namespace weft::physics
