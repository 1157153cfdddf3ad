// How far bodies may move before a list of pairs is to be made anew: each by an allowance of its own.
//
// Let pairs be left out that are farther apart than some range and the allowances of both. They cannot come within the
// range as long as no body is farther than its allowance from where it was then, but for what is common to all motion.
// So a short list, pruned from one with a wide skin, serves for several intervals. (Dual pair lists: Páll, Zhmurov,
// Bauer, Abraham, Lundborg, Gray, Hess, Lindahl 2020.)
#pragma once

#include <array>
#include <vector>

#include "physics/contact/self/blocks.h"
#include "physics/contact/self/pair_search.h"

namespace weft::physics {

class Allowances {
 public:
  Allowances(const Blocks& blocks, const std::vector<NamedSheet>& named, std::size_t bodies,
             const KernelTable& kernels);
  // The most that an allowance is, where a body does not move farther in one interval [m].
  void limit(float most) { most_ = most; }

  // No list is there.
  void forget() { given_ = false; }
  // Whether no body leaves its allowance in an interval.
  bool hold(const Place* place, const Displacement* moved, Threads& threads);
  // A list is made of what lies as at the start of an interval. Allowances are for several intervals in which bodies
  // move as in this one.
  void give(const Place* place, const Displacement* moved, Threads& threads);
  // m
  float of(std::int32_t body) const { return from_[std::size_t(body)].x[3]; }
  // How far a body had come when lists were made, since they were the time before; 0 where there were none [m].
  float came(std::int32_t body) const { return came_[std::size_t(body)]; }

  std::size_t bytes() const { return from_.size() * (sizeof(Place) + 4) + strayed_.size(); }

 private:
  using Way = std::array<float, 3>;

  std::int32_t first_of(const Block& block, int row) const;
  Way mean(const Displacement* moved) const;
  void give(std::size_t block, const Way& common, const Place* place, const Displacement* moved);
  template <class Visit>
  void for_each_block(Threads& threads, const Visit& visit) const;

  const Blocks& blocks_;
  const std::vector<NamedSheet>& named_;
  const KernelTable& kernels_;
  std::vector<Place> from_;            // where every body was, and its allowance
  std::vector<float> came_;            // m, of every body
  std::vector<std::uint8_t> strayed_;  // blocks
  Way common_{};                       // m, since then
  float most_ = 0;
  bool given_ = false;
};

}  // namespace weft::physics
