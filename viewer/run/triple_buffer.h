// One writer hands values to one reader without either ever waiting: the writer fills the back slot
// and swaps it with the middle one, the reader swaps the middle one with its own when it is newer.
#pragma once

#include <array>
#include <atomic>

namespace weft::viewer {

template <class T>
class TripleBuffer {
 public:
  // The writer's: fill it, then publish it. It holds what was published some time before.
  T& back() { return slots_[back_]; }
  void publish() { back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kSlot; }

  // The reader's: take() gives whether there is something newer, which front() then shows.
  bool take() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kSlot;
    return true;
  }
  const T& front() const { return slots_[front_]; }

 private:
  static constexpr unsigned kSlot = 3, kFresh = 4;
  std::array<T, 3> slots_{};
  std::atomic<unsigned> middle_{1};
  unsigned back_ = 0, front_ = 2;
};

}  // namespace weft::viewer
