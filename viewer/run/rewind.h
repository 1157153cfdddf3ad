// The last seconds of a run: a ring of states, bounded by memory and by count.
#pragma once

#include <deque>

#include "weft/simulation.h"

namespace weft::viewer {

class Rewind {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20;
  static constexpr int kMostStates = 600;

  void clear();
  // Keeps the state as the newest; forgets the oldest ones beyond the bounds.
  void keep(weft::Snapshot snapshot);
  // Forgets all states after the one that lies `back` before the newest.
  void cut(int back);
  const weft::Snapshot& at(int back) const {
    return snapshots_[snapshots_.size() - 1 - std::size_t(back)];
  }
  int size() const { return static_cast<int>(snapshots_.size()); }
  double seconds() const;  // from the oldest to the newest

 private:
  std::deque<weft::Snapshot> snapshots_;
  std::size_t bytes_ = 0;
};

}  // namespace weft::viewer
