// throughput: time per particle-step and per constraint, with Google Benchmark.
//
// The machine may be shared and noisy: every benchmark is repeated many times for a short time, all
// repetitions of all benchmarks are interleaved at random, and the fastest iteration counts.
// Nothing here fails because something was slow. Own options: --short, --out FILE.json; all options
// of Google Benchmark work too (--benchmark_filter=step/spring).
#include "throughput.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>

#include "limits.h"
#include "machine.h"

namespace {

double smallest(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

// Prints one line per benchmark and keeps its smallest values for the summary.
class Keeper : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const bool least = run.run_type == Run::RT_Aggregate && run.aggregate_name == "least";
      if (!least && !run.error_occurred) continue;
      bench::Figure f;
      f.name = run.run_name.function_name;
      for (const auto& [key, counter] : run.counters) f.counters.emplace_back(key, counter.value);
      if (run.error_occurred) f.error = run.error_message;
      const bool known = !figures.empty() && figures.back().name == f.name;
      if (!known) print(f), figures.push_back(std::move(f));
    }
  }
  std::vector<bench::Figure> figures;

 private:
  static void print(const bench::Figure& f) {
    if (!f.error.empty()) return void(std::printf("%-66s %s\n", f.name.c_str(), f.error.c_str()));
    std::printf("%-66s", f.name.c_str());
    for (const auto& [key, value] : f.counters) {
      if (key == "ms/frame")
        std::printf("  %.0f frames/s", 1e3 / value);
      else
        std::printf("  %8.4f %s", value, key.c_str());
    }
    std::printf("\n");
    std::fflush(stdout);
  }
};

void print_limits() {
  std::printf("%s\n", bench::machine_line().c_str());
  std::printf("triad, one thread:");
  for (const auto& level : bench::limits().triad)
    std::printf("  %s %.0f GB/s", level.name.c_str(), level.gigabytes);
  std::printf("\nsquare root and division:");
  for (weft::Simd s : {weft::Simd::scalar, weft::Simd::sse2, weft::Simd::avx2, weft::Simd::avx512})
    if (weft::simd_available(s))
      std::printf("  %s %.3f ns", weft::simd_name(s), bench::limits().sqrt_div(s));
  std::printf(" a constraint\n\n");
}

}  // namespace

benchmark::internal::Benchmark* bench::add_benchmark(const std::string& name,
                                                     std::function<void(benchmark::State&)> body) {
  return benchmark::RegisterBenchmark(name.c_str(), std::move(body))
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond)
      ->ComputeStatistics("least", smallest)
      ->ReportAggregatesOnly();
}

int main(int argc, char** argv) {
  std::string out = "throughput.json";
  bool quick = false;
  std::vector<std::string> words{argv[0], "--benchmark_enable_random_interleaving=true",
                                 "--benchmark_min_time=0.02", "--benchmark_repetitions=10"};
  for (int n = 1; n < argc; ++n) {
    if (std::strcmp(argv[n], "--short") == 0)
      quick = true;
    else if (std::strcmp(argv[n], "--out") == 0 && n + 1 < argc)
      out = argv[++n];
    else
      words.emplace_back(argv[n]);
  }
  std::vector<char*> pointers;
  for (std::string& w : words) pointers.push_back(w.data());
  int count = int(pointers.size());
  benchmark::Initialize(&count, pointers.data());
  if (benchmark::ReportUnrecognizedArguments(count, pointers.data())) return 2;
  try {
    print_limits();
    bench::register_steps(quick);
    bench::register_stages(quick);
    bench::register_features(quick);
    bench::register_self_collision(quick);
    bench::register_scenes(quick);
    Keeper keeper;
    benchmark::RunSpecifiedBenchmarks(&keeper);
    bench::print_summary(keeper.figures);
    bench::write_figures(out, keeper.figures);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "throughput: %s\n", e.what());
    return 1;
  }
}
