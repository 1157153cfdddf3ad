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

// Lists the pairs of a chunk that touch; `anew`, those are chosen first that others may push into each
// other in this run.
void SelfContact::list_touching(Close& close, const PairSearch::Pairs& all, bool anew) {
  const auto room = [](PairList& list, std::size_t count) {
    if (list.owner.size() < count + kPadding) {
      list.owner.resize(2 * count + kPadding);
      list.neighbour.resize(list.owner.size());
    }
    return PairRoom{list.owner.data(), list.neighbour.data()};
  };
  ClosePairs p{};
  p.place = place_.data();
  p.reach = kClose;
  p.touching = room(close.touching, all.count);
  if (anew) {
    p.pairs = int(all.count);
    p.owner = all.owner;
    p.neighbour = all.neighbour;
    p.close = room(close.pairs, all.count);
  } else {
    p.pairs = close.pairs.count;
    p.owner = close.pairs.owner.data();
    p.neighbour = close.pairs.neighbour.data();
  }
  const CloseFound found = kernels_.close_pairs(p);
  if (anew) close.pairs.count = found.close;
  close.touching.count = found.touching;
}

double SelfContact::respond(double dt, int since, Threads& threads) {
  if (found_ == 0) return 0;
  const bool alone = few_pairs() || threads.count() == 1;
  const auto each_block = [&](auto kernel) {
    threads.share(blocks_.all().size(), alone, [&](std::size_t b) {
      if (blocks_.all()[b].active) kernel(bodies_of(blocks_.all()[b], since * dt));
    });
  };
  each_block(kernels_.gather_bodies);
  if (close_.size() < search_.chunks()) close_.resize(search_.chunks());
  parts_.resize(alone ? 1 : std::size_t(threads.count()));
  const BodyFriction friction{friction_.empty() ? nullptr : friction_.data(), friction_alike_};
  // The course's push for as many substeps as have passed.
  const double steps = scene_.time.substeps > 0 ? scene_.time.substeps : scene_.time.frame / dt;
  const int iterations = course_ ? 1 : kIterations;
  for (int i = 0; i < iterations; ++i) {
    threads.share(search_.chunks(), alone, [&](std::size_t k) {
      Close& close = close_[k];
      list_touching(close, search_.pairs(k), i == 0);
      const PairList& pairs = close.touching;
      if (close.asked.size() < std::size_t(pairs.count) + kPadding)
        close.asked.resize(2 * std::size_t(pairs.count) + kPadding);
      close.fastest =
          kernels_.ask_pairs({place_.data(), motion_.data(), friction, pairs.count,
                              pairs.owner.data(), pairs.neighbour.data(), close.asked.data()});
    });
    // Each part of the bodies goes through all that is asked, in the same order.
    std::size_t asked = 0;
    for (std::size_t k = 0; k < search_.chunks(); ++k)
      asked += 2 * std::size_t(close_[k].touching.count);
    threads.share(parts_.size(), alone, [&](std::size_t part) {
      std::vector<std::int32_t>& bodies = parts_[part];
      if (bodies.size() < asked + 1) bodies.resize(2 * asked + 1);
      int count = 0;
      for (std::size_t k = 0; k < search_.chunks(); ++k) {
        const PairList& pairs = close_[k].touching;
        count += kernels_.sum_asked({pairs.count, pairs.owner.data(), pairs.neighbour.data(),
                                     close_[k].asked.data(),
                                     std::int32_t(bodies_ * part / parts_.size()),
                                     std::int32_t(bodies_ * (part + 1) / parts_.size()),
                                     sums_.data(), bodies.data() + count});
      }
      kernels_.move_bodies({place_.data(), motion_.data(), friction, sums_.data(), count,
                            bodies.data(), float(since / steps), float(1 / dt)});
    });
  }
  each_block(kernels_.scatter_bodies);
  float fastest = 0;
  for (std::size_t k = 0; k < search_.chunks(); ++k) fastest = std::max(fastest, close_[k].fastest);
  return std::sqrt(fastest);
}

}  // namespace weft::physics
