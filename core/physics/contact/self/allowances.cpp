// Allowances of bodies (allowances.h).
#include "physics/contact/self/allowances.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace weft::physics {
namespace {

// Intervals that a list is made for, and how much faster bodies may become.
constexpr float kIntervals = 8, kFaster = 1.25f;
// Of the greatest allowance, that bodies at rest have.
constexpr float kAtRest = 0.1f;
constexpr std::size_t kFewBlocks = 64;  // that one thread does faster

}  // namespace

Allowances::Allowances(const Blocks& blocks, const std::vector<NamedSheet>& named,
                       std::size_t bodies, const KernelTable& kernels)
    : blocks_(blocks),
      named_(named),
      kernels_(kernels),
      from_(bodies + kPacket),
      came_(bodies),
      strayed_(blocks.all().size()) {}

std::int32_t Allowances::first_of(const Block& block, int row) const {
  return named_[std::size_t(block.sheet)].name(block.row + row, block.column);
}

// The mean of some: any would do, this one makes ways short.
auto Allowances::mean(const Displacement* moved) const -> Way {
  double sum[3] = {};
  for (const Block& block : blocks_.all())
    for (std::size_t k = 0; k < 3; ++k) sum[k] += double(moved[first_of(block, 0)].u[k]);
  Way mean;
  for (std::size_t k = 0; k < 3; ++k) mean[k] = float(sum[k] / double(blocks_.all().size()));
  return mean;
}

// visit(block).
template <class Visit>
void Allowances::for_each_block(Threads& threads, const Visit& visit) const {
  threads.share(strayed_.size(), strayed_.size() < kFewBlocks, visit);
}

bool Allowances::hold(const Place* place, const Displacement* moved, Threads& threads) {
  if (!given_) return false;
  const Way common = mean(moved);
  for_each_block(threads, [&](std::size_t b) {
    const Block& block = blocks_.all()[b];
    const auto first = std::size_t(first_of(block, 0));
    StrayedBodies bodies{};
    bodies.columns = block.columns;
    bodies.rows = block.rows;
    bodies.stride = named_[std::size_t(block.sheet)].stride;
    bodies.from = from_.data() + first;
    bodies.place = place + first;
    bodies.moved = moved + first;
    for (std::size_t k = 0; k < 3; ++k) bodies.before[k] = common_[k], bodies.common[k] = common[k];
    strayed_[b] = kernels_.sheets.any_strayed(bodies);
  });
  for (std::size_t k = 0; k < 3; ++k) common_[k] += common[k];
  return std::ranges::find(strayed_, 1) == strayed_.end();
}

// Whole records, four floats at once; the last of a displacement is none.
void Allowances::give(std::size_t b, const Way& common, const Place* place,
                      const Displacement* moved) {
  using Record = Eigen::Array4f;
  const Block& block = blocks_.all()[b];
  const Record mean(common[0], common[1], common[2], 0);
  const Record before(common_[0] - common[0], common_[1] - common[1], common_[2] - common[2], 0);
  float square = 0;
  const auto for_each = [&](const auto& visit) {
    for (int j = 0; j < block.rows; ++j)
      for (std::int32_t n = first_of(block, j), end = n + block.columns; n < end; ++n)
        visit(std::size_t(n));
  };
  for_each([&](std::size_t n) {
    const Record off = Record::Map(moved[n].u) - mean, squared = off * off;
    square = std::max(square, squared[0] + squared[1] + squared[2]);
  });
  const float one = kFaster * std::sqrt(square);
  const float allowance = std::max(one, std::min(kIntervals * one, most_)) + kAtRest * most_;
  for_each([&](std::size_t n) {
    const Record off = Record::Map(place[n].x) - Record::Map(from_[n].x) - before;
    const Record squared = off * off;
    came_[n] = given_ ? std::sqrt(squared[0] + squared[1] + squared[2]) : 0;
    from_[n] = place[n];
    from_[n].x[3] = allowance;
  });
}

void Allowances::give(const Place* place, const Displacement* moved, Threads& threads) {
  const Way common = mean(moved);
  for_each_block(threads, [&](std::size_t b) { give(b, common, place, moved); });
  common_ = common;
  given_ = true;
}

}  // namespace weft::physics
