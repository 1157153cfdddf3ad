// How far squares have come (square_ways.h).
#include "physics/contact/self/square_ways.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace weft::physics {
namespace {

constexpr std::size_t kSample = 8;  // every so many squares tell what is common to all

}  // namespace

SquareWays::SquareWays(const std::vector<Square>& squares, std::size_t bodies)
    : squares_(squares), shift_(bodies) {}

void SquareWays::forget() {
  for (Ways* const ways : {&anywhere_, &beside_}) {
    ways->all.assign(squares_.size(), 0);
    ways->last.assign(squares_.size(), 0);
  }
  longest_ = 0;
}

// The mean of some: any would do, this one makes ways short.
void SquareWays::begin(const Displacement* moved) {
  double sum[3] = {};
  std::size_t count = 0;
  for (std::size_t n = 0; n < squares_.size(); n += kSample, ++count)
    for (int k = 0; k < 3; ++k) sum[k] += double(moved[squares_[n].corner[0]].u[k]);
  for (int k = 0; k < 3; ++k) common_[k] = float(sum[k] / double(std::max<std::size_t>(count, 1)));
}

// Whole records, four floats at once; the last of them is no displacement.
void SquareWays::add(std::size_t square, const Displacement* moved) {
  using Record = Eigen::Array4f;
  const std::int32_t* const corner = squares_[square].corner;
  Record u[4];
  float shift = 0;
  for (int c = 0; c < 4; ++c) {
    u[c] = Record::Map(moved[corner[c]].u);
    shift = std::max(shift, shift_[std::size_t(corner[c])]);
  }
  const auto farthest = [](float most, const Record& off) {
    const Record squared = off * off;
    return std::max(most, squared[0] + squared[1] + squared[2]);
  };
  const Record common = Record::Map(common_);
  float way = 0, apart = 0;
  for (int c = 0; c < 4; ++c) {
    way = farthest(way, u[c] - common);
    for (int other = 0; other < c; ++other) apart = farthest(apart, u[c] - u[other]);
  }
  const auto add = [&](Ways& to, float last, float before) {
    float& all = to.all[square];
    to.last[square] = kMargin * last;
    all = (all + kMargin * (last + before)) / kRoundedDown;
  };
  add(anywhere_, std::sqrt(way), shift);
  add(beside_, std::sqrt(apart), 2 * shift);
}

void SquareWays::end() {
  for (const std::int32_t body : shifted_) shift_[std::size_t(body)] = 0;
  shifted_.clear();
  for (const Ways* const ways : {&anywhere_, &beside_})
    longest_ = std::max(longest_, *std::max_element(ways->all.begin(), ways->all.end()));
}

void SquareWays::shift(std::int32_t body, float way) {
  shift_[std::size_t(body)] += way;
  shifted_.push_back(body);
}

}  // namespace weft::physics
