// Measures what sharing costs (sharing_costs.h): the fastest of many short repetitions, but for waking, where the
// middle one is what a frame meets.
#include "sharing_costs.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "machine.h"
#include "physics/step/threads.h"

namespace bench {
namespace {

using Clock = std::chrono::steady_clock;
using weft::physics::Threads;

double since(Clock::time_point start) {
  return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

template <class Work>
double fastest(int repetitions, Work&& work) {
  double best = Host::kNone;
  for (int n = 0; n < repetitions; ++n) {
    const auto start = Clock::now();
    work();
    best = std::min(best, since(start));
  }
  return best;
}

// Shares of one thread to two: what the first learns that the second has done its own.
void measure_shares(SharingCosts& costs) {
  Threads two(2);
  constexpr int kMany = 4096;
  two.together([&] {
    const auto nothing = [](std::size_t) {};
    costs.start_ns = 2 * fastest(300, [&] { two.share(kMany, false, nothing); }) / kMany;
    // There and back.
    std::atomic<int> turn = 0;
    constexpr int kTurns = 200;
    const auto turns = [&](std::size_t me) {
      for (int n = int(me); n < kTurns; n += 2) {
        while (turn.load(std::memory_order_acquire) != n) __builtin_ia32_pause();
        turn.store(n + 1, std::memory_order_release);
      }
    };
    costs.signal_ns = fastest(300,
                              [&] {
                                turn = 0;
                                two.share(2, false, turns);
                              }) /
                      kTurns;
  });
}

void measure_waking(SharingCosts& costs) {
  Threads two(2);
  std::vector<double> times;
  for (int n = 0; n < 60; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::atomic<int> there = 0;
    const auto start = Clock::now();
    two.together([&] {
      two.share(2, false, [&](std::size_t) {
        ++there;
        while (there.load() < 2) __builtin_ia32_pause();
      });
      times.push_back(since(start));
    });
  }
  std::nth_element(times.begin(), times.begin() + 30, times.end());
  costs.wake_ns = times[30];
}

using Floats = std::vector<float>;

void change(Floats& a, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) a[i] = a[i] * 0.5f + 1.0f;
}

// A buffer that two threads change in turn, against one of a size for the third level that one thread changes.
void measure_handover(SharingCosts& costs) {
  constexpr std::size_t kBytes = 128 * 1024, kLarge = 6 * 1024 * 1024;
  Floats shared(kBytes / sizeof(float), 0), large(kLarge / sizeof(float), 0);
  Threads two(2);
  constexpr int kTurns = 20;
  double turns = 0;
  two.together([&] {
    std::atomic<int> turn = 0;
    turns = fastest(100, [&] {
      turn = 0;
      two.share(2, false, [&](std::size_t me) {
        for (int n = int(me); n < kTurns; n += 2) {
          while (turn.load(std::memory_order_acquire) != n) __builtin_ia32_pause();
          change(shared, 0, shared.size());
          turn.store(n + 1, std::memory_order_release);
        }
      });
    });
  });
  const double alone = fastest(30, [&] { change(large, 0, large.size()); }) / kLarge;
  costs.handover_ns = std::max(0.0, turns / (kTurns * double(kBytes)) - alone);
}

void measure_memory(SharingCosts& costs) {
  constexpr std::size_t kBytes = 192 << 20;
  Floats memory(kBytes / sizeof(float), 0);
  for (const int threads : {1, costs.cores}) {
    Threads all(threads);
    const std::size_t part = memory.size() / std::size_t(threads);
    const double ns = fastest(6, [&] {
      all.share(std::size_t(threads), threads == 1,
                [&](std::size_t n) { change(memory, n * part, (n + 1) * part); });
    });
    (threads == 1 ? costs.core_rate : costs.all_rate) = 2 * double(kBytes) / ns;
  }
  costs.all_rate = std::max(costs.all_rate, costs.core_rate);
}

// As the system tells it; where it does not, as most servers have at least.
double last_level_bytes() {
  double kilobytes = 0;
  for (int level = 0; level < 5; ++level) {
    std::ifstream in("/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(level) + "/size");
    double size;
    if (in >> size) kilobytes = std::max(kilobytes, size);
  }
  return kilobytes > 0 ? kilobytes * 1024 : 32e6;
}

}  // namespace

SharingCosts measure_sharing_costs() {
  SharingCosts costs;
  costs.cores = machine().cores;
  measure_shares(costs);
  measure_waking(costs);
  measure_handover(costs);
  measure_memory(costs);
  costs.cache_bytes = last_level_bytes();
  return costs;
}

}  // namespace bench
