// The ring of states.
#include "run/rewind.h"

namespace weft::viewer {

void Rewind::clear() {
  snapshots_.clear();
  bytes_ = 0;
}

void Rewind::keep(weft::Snapshot snapshot) {
  bytes_ += snapshot.bytes();
  snapshots_.push_back(std::move(snapshot));
  while (size() > 1 && (size() > kMostStates || bytes_ > kMostBytes)) {
    bytes_ -= snapshots_.front().bytes();
    snapshots_.pop_front();
  }
}

void Rewind::cut(int back) {
  for (; back > 0 && size() > 1; --back) {
    bytes_ -= snapshots_.back().bytes();
    snapshots_.pop_back();
  }
}

double Rewind::seconds() const {
  return snapshots_.empty() ? 0 : snapshots_.back().time - snapshots_.front().time;
}

}  // namespace weft::viewer
