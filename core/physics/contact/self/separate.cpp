// Self-collision (self_contact.h): pairs pushed apart, chunk by chunk (kernels/separate.cpp).
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "physics/contact/self/self_contact.h"

namespace weft::physics {
namespace {

// Of pushing apart in one run, as long as pairs of a list touch. Where the last run was so few substeps
// ago, what is left is pushed apart soon: then as long as they are deeper in each other than so much of
// the distance at which they are held.
constexpr int kIterations = 3;
constexpr int kSoon = 2;
constexpr float kShallow = 0.02f;
constexpr std::size_t kFewLists = 8;  // that one thread does faster
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
  b.moved = moved_.data();
  b.first_body = std::int32_t(first);
  b.loaded = loaded_[sheet].data() +
             (std::size_t(block.row) * std::size_t(l.stride) + std::size_t(block.column)) / 16;
  return b;
}

PairRoom SelfContact::PairList::room(std::size_t pairs) {
  if (owner.size() < pairs + kPadding) {
    owner.resize(2 * pairs + kPadding);
    neighbour.resize(owner.size());
  }
  return {owner.data(), neighbour.data()};
}

// Lists those within a range whose first is of this block.
void SelfContact::list_beside(std::size_t block, float range) {
  const Block& b = blocks_.all()[block];
  const auto sheet = std::size_t(b.sheet);
  Lattice& l = *sheets_[sheet].lattice;
  PairList& found = beside_[block];
  BesidePairs p{};
  p.x = l.x.row(0);
  p.stride = l.stride;
  p.columns = l.columns;
  p.rows = l.rows;
  p.column = b.column;
  p.block_columns = b.columns;
  p.step = steps_[sheet].data();
  p.steps = int(steps_[sheet].size());
  p.range_squared = range * range;
  p.first = named_[sheet].first;
  p.name_stride = named_[sheet].stride;
  const int most_in_row = b.columns * p.steps;
  found.count = 0;
  for (int done = 0; done < b.rows;) {
    p.row = b.row + done;
    p.block_rows = b.rows - done;
    p.pairs = found.room(std::size_t(found.count + most_in_row)).from(found.count);
    p.most = int(found.owner.size() - kPadding) - found.count - most_in_row;
    const BesideFound some = kernels_.beside_pairs(p);
    done += some.rows;
    found.count += some.pairs;
  }
  // What kernels may read beyond the last.
  std::fill_n(found.owner.begin() + found.count, kPadding, 0);
  std::fill_n(found.neighbour.begin() + found.count, kPadding, 0);
}

// Lists those of all pairs that touch; `anew`, the close ones are chosen first, those that others may
// push into each other in this run.
void SelfContact::list_touching(const PairSearch::Pairs& all, bool anew, PairList& close,
                                Touching& touching) {
  ClosePairs p{};
  p.place = place_.data();
  p.reach = kClose;
  p.touching = touching.pairs.room(anew ? all.count : std::size_t(close.count));
  if (anew) {
    p.pairs = int(all.count);
    p.owner = all.owner;
    p.neighbour = all.neighbour;
    p.close = close.room(all.count);
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
  p.count += kernels_.sum_asked({pairs.count, pairs.owner.data(), pairs.neighbour.data(),
                                 touching.asked.data(), first_of_part(part),
                                 first_of_part(part + 1), sums_.data(), p.bodies.data() + p.count});
}

// Takes up the bodies as they are now, and which lists of pairs to look at: those of the chunks of the
// search, and of blocks where any beside each other are close.
void SelfContact::gather(double since, bool alone, Threads& threads) {
  const std::vector<Block>& blocks = blocks_.all();
  threads.share(blocks.size(), alone, [&](std::size_t b) {
    if (!blocks[b].active) return;
    const BodyBlock bodies = bodies_of(blocks[b], since);
    kernels_.gather_bodies(bodies);
    list_beside(b, kClose * bodies.held);
  });
  std::fill(moved_.begin(), moved_.end(), std::uint8_t(0));
  const std::size_t chunks = search_.chunks();
  lists_.resize(chunks);
  std::iota(lists_.begin(), lists_.end(), std::size_t(0));
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (blocks[b].active && beside_[b].count > 0) lists_.push_back(chunks + b);
  found_asked_.resize(chunks + blocks.size());
  if (close_.size() < chunks) close_.resize(chunks);
  if (touching_.size() < lists_.size()) touching_.resize(lists_.size());
}

// Pushes apart what touches of the lists, once; the first time, what is close is chosen too.
void SelfContact::push_apart(bool first, const Push& push, bool alone, Threads& threads) {
  const std::size_t chunks = search_.chunks();
  const bool one = parts_.size() == 1;
  for (Part& part : parts_) part.count = 0;
  threads.share(lists_.size(), alone, [&](std::size_t n) {
    const std::size_t k = lists_[n];
    Touching& touching = touching_[one ? 0 : n];
    if (k < chunks)
      list_touching(search_.pairs(k), first, close_[k], touching);
    else
      list_touching({}, false, beside_[k - chunks], touching);
    found_asked_[k] = ask(push.friction, touching);
    if (one) sum_up(0, touching);
  });
  // Each part of the bodies goes through all that is asked, in the same order.
  threads.share(parts_.size(), alone, [&](std::size_t n) {
    const Part& part = parts_[n];
    for (std::size_t k = 0; k < lists_.size() && !one; ++k) sum_up(n, touching_[k]);
    kernels_.move_bodies({place_.data(), motion_.data(), push.friction, sums_.data(), part.count,
                          part.bodies.data(), moved_.data(), push.course_share, push.inverse_dt});
  });
}

SelfContact::Met SelfContact::respond(double dt, int since, Threads& threads) {
  if (count_ == 0) return {};
  const bool alone = few() || threads.count() == 1;
  parts_.resize(alone ? 1 : std::size_t(threads.count()));
  gather(since * dt, alone, threads);
  // The course's push for as many substeps as have passed.
  const double steps = scene_.time.substeps > 0 ? scene_.time.substeps : scene_.time.frame / dt;
  const Push push{{friction_.empty() ? nullptr : friction_.data(), friction_alike_},
                  float(since / steps),
                  float(1 / dt)};
  const int iterations = course_ ? 1 : kIterations;
  const float shallow = since <= kSoon ? kShallow : 0;
  float fastest_squared = 0, deepest = 0;
  for (int i = 0; i < iterations && !lists_.empty(); ++i) {
    push_apart(i == 0, push, alone || lists_.size() < kFewLists, threads);
    // Depths as they are at first, speeds as they are when a list is left.
    for (std::size_t n = 0; n < lists_.size() && i == 0; ++n)
      deepest = std::max(deepest, found_asked_[lists_[n]].deepest);
    std::erase_if(lists_, [&](std::size_t k) {
      const bool left = i + 1 == iterations || found_asked_[k].deepest <= shallow;
      if (left) fastest_squared = std::max(fastest_squared, found_asked_[k].fastest_squared);
      return left;
    });
  }
  threads.share(blocks_.all().size(), alone, [&](std::size_t b) {
    const Block& block = blocks_.all()[b];
    if (block.active) kernels_.scatter_bodies(bodies_of(block, since * dt));
  });
  return {std::sqrt(fastest_squared), deepest};
}

}  // namespace weft::physics
