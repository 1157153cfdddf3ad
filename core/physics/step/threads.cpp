// The threads of a simulation (threads.h).
#include "physics/step/threads.h"

#include <oneapi/tbb/info.h>

#include <chrono>
#include <latch>
#include <system_error>
#include <thread>
#include <vector>

namespace weft::physics {
namespace {

// Of so many threads, how many the system gives at once beside those that there are: they are started
// and ended. oneTBB starts its threads from each other and ends the process where one cannot be had
// (a limit on processes or on memory), so this is found out before.
int startable(int wanted) {
  std::vector<std::thread> started;
  started.reserve(std::size_t(wanted));
  std::latch all(1);
  try {
    while (int(started.size()) < wanted) started.emplace_back([&] { all.wait(); });
  } catch (const std::system_error&) {
  }
  all.count_down();
  for (std::thread& thread : started) thread.join();
  // The system counts a thread for a moment after it has ended.
  if (int(started.size()) < wanted) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return int(started.size());
}

// A pile's word: the round's number, the end of its shares, and the next one to be taken.
constexpr int kShareBits = 16;
std::uint64_t pile_of(std::uint64_t round, std::uint64_t begin, std::uint64_t end) {
  return (round << kShareBits | end) << kShareBits | begin;
}
std::uint64_t end_of(std::uint64_t pile) {
  return pile >> kShareBits & 0xffff;
}
std::uint64_t next_of(std::uint64_t pile) {
  return pile & 0xffff;
}

}  // namespace

void Patience::wait() {
  if (++waits_ > kBusyWaits) return std::this_thread::yield();
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

Threads::Threads(int count)
    : asked_(count > 0 ? count : oneapi::tbb::info::default_concurrency()),
      count_(asked_ > 1 ? 1 + startable(asked_ - 1) : 1),
      allowed_(count_ > oneapi::tbb::info::default_concurrency()
                   ? std::make_unique<oneapi::tbb::global_control>(
                         oneapi::tbb::global_control::max_allowed_parallelism,
                         static_cast<std::size_t>(count_))
                   : nullptr),
      arena_(count_),
      piles_(std::make_unique<Pile[]>(std::size_t(count_))) {}

// A share is worked on only between its taking and its counting as done, and the round ends when all
// are done: what the round is about never changes under whoever works on it. Every thread begins with
// a pile of its own, so that the same rows come to the same caches in every round: the caller's, which
// the others might take from, is there last.
void Threads::share_out(int shares, const void* work, Call call) {
  work_ = work;
  call_ = call;
  done_.store(0, std::memory_order_relaxed);
  ++round_;
  for (int t = count_ - 1; t >= 0; --t)
    piles_[t].left.store(pile_of(round_, std::uint64_t(shares * t / count_),
                                 std::uint64_t(shares * (t + 1) / count_)),
                         std::memory_order_release);
  while (take_any()) {
  }
  for (Patience patience; done_.load(std::memory_order_acquire) < shares;) patience.wait();
}

bool Threads::take_any() {
  const int own = index();
  for (int n = 0; n < count_; ++n)
    if (take(piles_[(own + n) % count_])) return true;
  return false;
}

// Works on one share; false when none is left to take.
bool Threads::take(Pile& pile) {
  std::uint64_t left = pile.left.load(std::memory_order_acquire);
  if (next_of(left) >= end_of(left)) return false;
  left = pile.left.fetch_add(1, std::memory_order_acq_rel);
  if (next_of(left) >= end_of(left)) return false;
  call_(work_, int(next_of(left)));
  done_.fetch_add(1, std::memory_order_release);
  return true;
}

void Threads::help() {
  Patience patience;
  while (!over_.load(std::memory_order_acquire))
    if (take_any())
      patience = {};
    else
      patience.wait();
}

}  // namespace weft::physics
