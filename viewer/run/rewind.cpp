// The ring of states.
#include "run/rewind.h"

namespace weft::viewer {

void Rewind::clear() {
  moments_.clear();
  bytes_ = 0;
}

void Rewind::keep(Moment moment) {
  bytes_ += moment.bytes();
  moments_.push_back(std::move(moment));
  while (size() > 1 && (size() > kMostStates || bytes_ > kMostBytes)) {
    bytes_ -= moments_.front().bytes();
    moments_.pop_front();
  }
}

void Rewind::cut(int back) {
  for (; back > 0 && size() > 1; --back) {
    bytes_ -= moments_.back().bytes();
    moments_.pop_back();
  }
}

double Rewind::seconds() const {
  return moments_.empty() ? 0 : moments_.back().time - moments_.front().time;
}

}  // namespace weft::viewer
