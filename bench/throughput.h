// The groups of benchmarks that `throughput` is made of, and what they share.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

#include "weft/simulation.h"

namespace bench {

// Each registers its benchmarks; `quick` leaves out large sheets and rare combinations.
void register_steps(bool quick);     // whole steps: method x size x instruction set x threads
void register_stages(bool quick);    // every stage of the plan by itself
void register_features(bool quick);  // what a feature adds to a step
void register_scenes(bool quick);    // the seeds' scenes in frames a second; setup; memory

// Registers a benchmark of which the smallest values over all repetitions count.
benchmark::internal::Benchmark* add_benchmark(const std::string& name,
                                              std::function<void(benchmark::State&)> body);

// The sheet of `swing` with n x n particles whose frame is `substeps` substeps inside the stability
// limit of springs.
weft::Scene stepping_scene(int n, int substeps);

// The widest instruction set of this machine.
weft::Simd widest();

// Counters in ns per particle-step and per constraint, and how many times the machine's bound that
// is, for `steps` steps an iteration.
void count_work(benchmark::State& state, weft::Simd simd, double steps, double particles,
                double constraints);

// A benchmark's result: the smallest value of each of its counters over the repetitions.
struct Figure {
  std::string name;
  double ms = 0;  // an iteration
  std::vector<std::pair<std::string, double>> counters;
  std::string error;
  double counter(const std::string& counter_name) const;  // 0 when there is none
};

// Ratios, required figures, and the file the report is made from.
void print_summary(const std::vector<Figure>& figures);
void write_figures(const std::string& path, const std::vector<Figure>& figures);

}  // namespace bench
