// The seeds' scenes in frames a second, and what it costs to set a simulation up.
#include "throughput.h"

namespace bench {
namespace {

void add_scene(const std::string& name, double seconds, int threads) {
  const std::string full = "scene/" + name + "/threads:" + std::to_string(threads);
  add_benchmark(
      full, [=](benchmark::State& s) { run_frames(s, weft::read_scene(name), seconds, threads); })
      ->Iterations(1)
      ->Repetitions(2);
}

void set_up(benchmark::State& state, int n, weft::Method method) {
  weft::Scene scene = stepping_scene(n, 32);
  scene.solver.method = method;
  double bytes = 0;
  fastest_ns(state, [&] {
    weft::Simulation simulation(scene, {});
    simulation.advance_frame();  // makes the room a run needs
    bytes = simulation.bytes_per_particle();
  });
  state.counters["bytes/particle"] = bytes;
}

}  // namespace

void run_frames(benchmark::State& state, const weft::SceneFile& file, double seconds, int threads) {
  if (!file.faults.empty()) {
    state.SkipWithError("the scene cannot be read");
    return;
  }
  weft::Options options;
  options.threads = threads;
  constexpr int kRuns = 3;
  std::vector<double> fastest(std::size_t(seconds / file.scene.time.frame),
                              std::numeric_limits<double>::infinity());
  for (auto _ : state)
    for (int run = 0; run < kRuns; ++run) {
      weft::Simulation simulation(file.scene, options);
      for (double& best : fastest) {
        const auto start = std::chrono::steady_clock::now();
        simulation.advance_frame();
        const std::chrono::duration<double, std::milli> spent =
            std::chrono::steady_clock::now() - start;
        best = std::min(best, spent.count());
      }
      if (!simulation.status().ok) state.SkipWithError(simulation.status().text.c_str());
    }
  double sum = 0;
  for (double ms : fastest) sum += ms;
  state.counters["ms/frame"] = sum / double(fastest.size());
  state.counters["slowest ms"] = *std::max_element(fastest.begin() + 1, fastest.end());
}

void register_scenes(bool quick) {
  for (const char* scene : {"seed1", "seed2", "seed3"})
    for (const char* kind : {"positional", "spring", "friction"})
      add_scene(std::string(scene) + "_" + kind, quick ? 2 : 6, 1);
  for (int threads : {1, 2}) add_scene("pbr100", quick ? 1 : 3, threads);
  for (const auto& [method, word] :
       {std::pair{weft::Method::spring, "spring"}, std::pair{weft::Method::compliant, "compliant"}})
    for (int n : quick ? std::vector<int>{32, 100} : std::vector<int>{32, 100, 316, 1000}) {
      const weft::Method m = method;
      const std::string name = "setup/" + std::string(word) + "/" + std::to_string(n);
      add_benchmark(name, [=](benchmark::State& s) { set_up(s, n, m); });
    }
}

}  // namespace bench
