// Independent jobs on several threads: whoever is free takes the next one.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace weft {

// Threads to use where 0 means all cores.
inline int thread_count(int asked) {
  return asked > 0 ? asked : std::max(1, int(std::thread::hardware_concurrency()));
}

// The threads that each of `jobs` simulations gets, so that all cores are busy.
inline int threads_for_each(int threads, std::size_t jobs) {
  return std::max(1, threads / int(std::clamp<std::size_t>(jobs, 1, std::size_t(threads))));
}

// Calls work(k) for k = 0 … count-1, each once, on as many threads; the caller's is one of them. The
// first exception is thrown again here, once the others have finished what they are at; no job
// begins after it.
template <class Work>
void run_jobs(std::size_t count, int threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr error;
  std::mutex mutex;
  const auto take = [&] {
    for (std::size_t k = next++; k < count; k = next++) try {
        work(k);
      } catch (...) {
        const std::lock_guard hold(mutex);
        if (!error) error = std::current_exception();
        next = count;
      }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t t = 1; t < std::min(count, std::size_t(threads)); ++t)
      others.emplace_back(take);
    take();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace weft
