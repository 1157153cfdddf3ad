// The seeds' scenes in frames a second, and what it costs to set a simulation up.
#include "throughput.h"
#include "weft/read_scene.h"

namespace bench {
namespace {

// One iteration is the whole run from the start, setup left out.
void run_scene(benchmark::State& state, const std::string& name, double seconds, int threads) {
  const weft::SceneFile file = weft::read_scene(name);
  if (!file.faults.empty()) {
    state.SkipWithError("the scene cannot be read");
    return;
  }
  weft::Options options;
  options.threads = threads;
  std::int64_t frames = 0;
  double slowest = 0;
  for (auto _ : state) {
    state.PauseTiming();
    weft::Simulation simulation(file.scene, options);
    simulation.advance_frame();
    state.ResumeTiming();
    while (simulation.time() < seconds && simulation.status().ok) simulation.advance_frame();
    state.PauseTiming();
    frames += simulation.frame() - 1;
    slowest = simulation.report().wall_ms.frame_max;
    if (!simulation.status().ok) state.SkipWithError(simulation.status().text.c_str());
    state.ResumeTiming();
  }
  using benchmark::Counter;
  state.counters["s/frame"] = Counter(double(frames), Counter::kIsRate | Counter::kInvert);
  state.counters["slowest ms"] = slowest;
}

void add_scene(const std::string& name, double seconds, int threads) {
  const std::string full = "scene/" + name + "/threads:" + std::to_string(threads);
  add_benchmark(full, [=](benchmark::State& s) {
    run_scene(s, name, seconds, threads);
  })->Iterations(1);
}

void set_up(benchmark::State& state, int n, weft::Method method) {
  weft::Scene scene = stepping_scene(n, 32);
  scene.solver.method = method;
  double bytes = 0;
  for (auto _ : state) {
    weft::Simulation simulation(scene, {});
    simulation.advance_frame();  // makes the room a run needs
    state.PauseTiming();
    bytes = simulation.bytes_per_particle();
    state.ResumeTiming();
  }
  state.counters["bytes/particle"] = bytes;
}

}  // namespace

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
