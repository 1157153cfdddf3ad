// Sharing cloths out to threads (substep_runner.h).
#include "physics/frame/substep_runner.h"

#include <algorithm>

namespace weft::physics {
namespace {

// Share of the time that threads with a cloth each must be busy for: about what several make of one.
constexpr double kBusy = 0.9;

}  // namespace

SubstepRunner::SubstepRunner(int threads, std::size_t cloths) : threads_(threads) {
  apart_.reserve(cloths);
  busy_.reserve(std::size_t(threads_.count()));
}

void SubstepRunner::run(const Cloths& cloths, const Substeps& substeps, const Sleeping* sleeping,
                        std::span<RollbackBuffer> observers, Schedule::Part part) {
  const auto run = [&](std::size_t c, Threads& team) {
    cloths[c]->schedule().run(substeps, team,
                              sleeping ? sleeping->rows(c) : std::span<const RowSpan>(),
                              observers.empty() ? nullptr : &observers[c], part);
  };
  apart_.clear();
  for (std::size_t c = 0; c < cloths.size(); ++c)
    if (!is_asleep(sleeping, c)) apart_.push_back(c);
  bool apart = worth_running_apart(cloths, substeps.count, part) && keeps_busy(cloths, part);
  if (!apart) {
    std::size_t small = 0;
    for (const std::size_t c : apart_)
      if (cloths[c]->schedule().worth_sharing(cloths[c]->particles().count(), substeps.count,
                                              threads_.standing_by(), part))
        run(c, threads_);
      else
        apart_[small++] = c;
    apart_.resize(small);
    apart = worth_running_apart(cloths, substeps.count, part);
  }
  const auto run_apart = [&] {
    threads_.share(apart_.size(), !apart, [&](std::size_t n) { run(apart_[n], one_thread_); });
  };
  apart ? threads_.together(run_apart) : run_apart();
}

bool SubstepRunner::worth_running_apart(const Cloths& cloths, int substeps,
                                        Schedule::Part part) const {
  double all = 0;
  for (const std::size_t c : apart_) all += cloths[c]->schedule().cost(part);
  return apart_.size() > 1 && Schedule::worth_running_apart(all, substeps, threads_.standing_by());
}

// Whether these cloths, each going to the thread that is free first, keep threads busy for nearly all of
// the time.
bool SubstepRunner::keeps_busy(const Cloths& cloths, Schedule::Part part) {
  busy_.assign(std::size_t(threads_.count()), 0);
  double all = 0;
  for (const std::size_t c : apart_) {
    const double cost = cloths[c]->schedule().cost(part);
    *std::min_element(busy_.begin(), busy_.end()) += cost;
    all += cost;
  }
  const double longest = *std::max_element(busy_.begin(), busy_.end());
  return kBusy * longest * threads_.count() <= all;
}

}  // namespace weft::physics
