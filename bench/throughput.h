// The groups of benchmarks that `throughput` is made of, and what they share.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace bench {

// Each registers its benchmarks; `quick` leaves out large sheets and rare combinations.
void register_steps(bool quick);           // whole steps: method x size x instruction set x threads
void register_stages(bool quick);          // every stage of the plan by itself
void register_features(bool quick);        // what a feature adds to a step
void register_self_collision(bool quick);  // its parts: sort, search, response; scenes
void register_scenes(bool quick);          // the seeds' scenes in frames a second; setup; memory

// Registers a benchmark of which the smallest values over all repetitions count.
benchmark::internal::Benchmark* add_benchmark(const std::string& name,
                                              std::function<void(benchmark::State&)> body);

// The sheet of `swing` with n x n particles whose frame is `substeps` substeps inside the stability
// limit of springs.
weft::Scene stepping_scene(int n, int substeps);

// A scene from its start for `seconds`, several times; every frame's fastest time counts. Counters:
// the mean of the frames and the slowest one.
void run_frames(benchmark::State& state, const weft::SceneFile& file, double seconds, int threads);

// The widest instruction set of this machine.
weft::Simd widest();

// Runs `work` as often as the benchmark asks and gives the time of its fastest run [ns]. Where
// others use the machine, averages tell about them: only what is shorter than a time slice can be
// measured undisturbed, and only by its minimum.
template <class Work>
double fastest_ns(benchmark::State& state, Work&& work) {
  double best = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
    best = std::min(best, spent.count());
  }
  state.counters["ms"] = best * 1e-6;
  return best;
}

// What a run of `steps` steps took: ns per particle-step, per constraint, and how many times the
// machine's bound that is.
struct Work {
  double steps, particles, constraints;
};
void count_work(benchmark::State& state, weft::Simd simd, double ns, const Work& work);

// A benchmark's result: the smallest value of each of its counters over the repetitions.
struct Figure {
  std::string name;
  std::vector<std::pair<std::string, double>> counters;  // "ms" among them
  std::string error;
  double counter(const std::string& counter_name) const;  // 0 when there is none
};

// Ratios, required figures, and the file the report is made from.
void print_summary(const std::vector<Figure>& figures);
void write_figures(const std::string& path, const std::vector<Figure>& figures);

}  // namespace bench
