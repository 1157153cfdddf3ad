// Self-collision (self_collision.h): pairs pushed apart, chunk by chunk (kernels/separate.cpp).
#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/self_collision/self_collision.h"

namespace weft::physics {
namespace {

// Of pushing apart in one run, as long as pairs of a chunk touch. Where the last run was so few substeps
// ago, what is left is pushed apart soon: then as long as they are deeper in each other than so much of
// the distance at which they are held.
constexpr int kIterations = 3;
constexpr int kSoon = 2;
constexpr float kShallow = 0.02f;
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

// Lists those of all pairs that touch; `anew`, the close ones are chosen first, those that others may
// push into each other in this run.
void SelfContact::list_touching(const PairSearch::Pairs& all, bool anew, PairList& close,
                                Touching& touching) {
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
  p.touching = room(touching.pairs, all.count);
  if (anew) {
    p.pairs = int(all.count);
    p.owner = all.owner;
    p.neighbour = all.neighbour;
    p.close = room(close, all.count);
  } else {
    p.pairs = close.count;
    p.owner = close.owner.data();
    p.neighbour = close.neighbour.data();
  }
  const CloseFound found = kernels_.close_pairs(p);
  if (anew) close.count = found.close;
  touching.pairs.count = found.touching;
}

// What pairs that touch ask for.
AskFound SelfContact::ask(const BodyFriction& friction, Touching& touching) {
  const PairList& pairs = touching.pairs;
  if (touching.asked.size() < std::size_t(pairs.count) + kPadding)
    touching.asked.resize(2 * std::size_t(pairs.count) + kPadding);
  return kernels_.ask_pairs({place_.data(), motion_.data(), friction, pairs.count,
                             pairs.owner.data(), pairs.neighbour.data(), touching.asked.data()});
}

// Adds what they ask of the bodies of a part.
void SelfContact::sum_up(std::size_t part, const Touching& touching) {
  Part& p = parts_[part];
  const PairList& pairs = touching.pairs;
  const std::size_t most = std::size_t(p.count) + 2 * std::size_t(pairs.count) + 1;
  if (p.bodies.size() < most) p.bodies.resize(2 * most);
  p.count +=
      kernels_.sum_asked({pairs.count, pairs.owner.data(), pairs.neighbour.data(),
                          touching.asked.data(), std::int32_t(bodies_ * part / parts_.size()),
                          std::int32_t(bodies_ * (part + 1) / parts_.size()), sums_.data(),
                          p.bodies.data() + p.count});
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
  const std::size_t chunks = search_.chunks();
  found_asked_.resize(chunks);
  if (close_.size() < chunks) {
    close_.resize(chunks);
    touching_.resize(chunks);
  }
  parts_.resize(alone ? 1 : std::size_t(threads.count()));
  const BodyFriction friction{friction_.empty() ? nullptr : friction_.data(), friction_alike_};
  // The course's push for as many substeps as have passed.
  const double steps = scene_.time.substeps > 0 ? scene_.time.substeps : scene_.time.frame / dt;
  const int iterations = course_ ? 1 : kIterations;
  const float shallow = since <= kSoon ? kShallow : 0;
  for (int i = 0; i < iterations; ++i) {
    for (Part& part : parts_) part.count = 0;
    const bool one = parts_.size() == 1;
    threads.share(chunks, alone, [&](std::size_t k) {
      Touching& touching = touching_[one ? 0 : k];
      if (i > 0 && found_asked_[k].deepest <= shallow) {
        if (!one) touching.pairs.count = 0;
        return;
      }
      list_touching(search_.pairs(k), i == 0, close_[k], touching);
      found_asked_[k] = ask(friction, touching);
      if (one) sum_up(0, touching);
    });
    // Each part of the bodies goes through all that is asked, in the same order.
    threads.share(parts_.size(), alone, [&](std::size_t n) {
      const Part& part = parts_[n];
      for (std::size_t k = 0; k < chunks && !one; ++k) sum_up(n, touching_[k]);
      kernels_.move_bodies({place_.data(), motion_.data(), friction, sums_.data(), part.count,
                            part.bodies.data(), float(since / steps), float(1 / dt)});
    });
  }
  each_block(kernels_.scatter_bodies);
  float fastest_squared = 0;
  for (const AskFound& found : found_asked_)
    fastest_squared = std::max(fastest_squared, found.fastest_squared);
  return std::sqrt(fastest_squared);
}

}  // namespace weft::physics
