// Whole steps of every method: ns per particle-step and per constraint.
#include <cmath>

#include "limits.h"
#include "throughput.h"
#include "verlet.h"

namespace bench {
namespace {

struct Way {
  const char* name;
  weft::Method method;
  weft::Sweep sweep;
  bool membrane = false;  // woven, in place of springs
  bool tethered = false;  // with substeps of the second order
};

constexpr Way kWays[] = {
    {"spring", weft::Method::spring, weft::Sweep::gauss_seidel},
    {"spring_friction", weft::Method::spring_friction, weft::Sweep::gauss_seidel},
    {"positional_gauss_seidel", weft::Method::positional, weft::Sweep::gauss_seidel},
    {"positional_jacobi", weft::Method::positional, weft::Sweep::jacobi},
    {"compliant_gauss_seidel", weft::Method::compliant, weft::Sweep::gauss_seidel},
    {"compliant_jacobi", weft::Method::compliant, weft::Sweep::jacobi},
    {"compliant_line", weft::Method::compliant, weft::Sweep::line},
    {"compliant_line_tethered", weft::Method::compliant, weft::Sweep::line, false, true},
    {"compliant_membrane_gauss_seidel", weft::Method::compliant, weft::Sweep::gauss_seidel, true},
    {"compliant_membrane_line", weft::Method::compliant, weft::Sweep::line, true, false},
    {"compliant_membrane_line_tethered", weft::Method::compliant, weft::Sweep::line, true, true},
};

// About as many as a frame of 1/60 s is given: explicit springs need hundreds.
int substeps_of(int n, weft::Method method) {
  const bool springs = method == weft::Method::spring || method == weft::Method::spring_friction;
  return (n <= 100 ? 32 : n <= 400 ? 16 : 8) * (springs ? 5 : 1);
}

bool has_stage(const weft::Plan& plan, const std::string& word) {
  for (const weft::PlannedStage& s : plan.stages)
    if ((s.name + s.detail).find(word) != std::string::npos) return true;
  return false;
}

weft::Scene scene_of(const Way& way, int n) {
  const int substeps = substeps_of(n, way.method);
  weft::Scene scene = stepping_scene(n, substeps);
  scene.solver.method = way.method;
  scene.solver.sweep = way.sweep;
  if (way.sweep == weft::Sweep::line) scene.time.frame = substeps / 480.0;
  if (way.membrane) {
    scene.cloths[0].stiffness = weft::Cloth().stiffness;
    scene.cloths[0].membrane = {3000, 2000, 200, 80, 0};
  }
  if (way.tethered) {
    scene.solver.tethers = true;
    scene.solver.order = 2;
    scene.time.frame = substeps / 960.0;
  }
  if (way.method == weft::Method::spring_friction)
    scene.cloths[0].spring_damping = {0.001, 0.001, 0.001};
  return scene;
}

// Of a frame; 0 where the way is not run as it is meant.
double frame_ns(benchmark::State& state, const Way& way, weft::Simulation& simulation) {
  if (way.sweep == weft::Sweep::line && !has_stage(simulation.plan(), "line")) {
    state.SkipWithError("no line sweeps in the plan");
    return 0;
  }
  simulation.advance_frame();  // makes room for what the run needs
  const double ns = fastest_ns(state, [&] { simulation.advance_frame(); });
  if (!simulation.status().ok) state.SkipWithError(simulation.status().text.c_str());
  state.counters["substeps"] = simulation.plan().substeps;
  return ns;
}

void step(benchmark::State& state, const Way& way, int n, weft::Simd simd, int threads) {
  weft::Options options;
  options.simd = simd;
  options.threads = threads;
  weft::Simulation simulation(scene_of(way, n), options);
  const double ns = frame_ns(state, way, simulation);
  if (ns == 0) return;
  const weft::Report r = simulation.report(false);
  const auto& c = r.constraints;
  count_work(state, simd, ns,
             {double(simulation.plan().substeps), double(r.particles),
              double(c.structural + c.shear + c.bend)});
}

// Four sheets, which two threads can run side by side.
void step_four(benchmark::State& state, const Way& way, int n, int threads) {
  weft::Scene scene = scene_of(way, n);
  scene.cloths.resize(4, scene.cloths[0]);
  weft::Options options;
  options.threads = threads;
  weft::Simulation simulation(scene, options);
  frame_ns(state, way, simulation);
}

void add(const Way& way, int n, weft::Simd simd, int threads) {
  const std::string name = "step/" + std::string(way.name) + "/" + std::to_string(n) + "/" +
                           weft::simd_name(simd) + "/threads:" + std::to_string(threads);
  add_benchmark(name, [=](benchmark::State& s) { step(s, way, n, simd, threads); });
}

}  // namespace

weft::Simd widest() {
  for (weft::Simd s : {weft::Simd::avx512, weft::Simd::avx2})
    if (weft::simd_available(s)) return s;
  return weft::Simd::sse2;
}

weft::Scene stepping_scene(int n, int substeps) {
  weft::Scene scene;
  weft::Cloth cloth;
  cloth.grid.nx = cloth.grid.ny = n;
  cloth.pins = {{0, 0, {}}, {n - 1, 0, {}}};
  scene.cloths.push_back(cloth);
  // Room below the limit for the stretch of a sheet that falls for a while.
  scene.time.frame = 0.8 * substeps * Verlet(scene).safe_step();
  scene.time.substeps = substeps;
  return scene;
}

void count_work(benchmark::State& state, weft::Simd simd, double ns, const Work& work) {
  // A step reads and writes position and velocity and reads the inverse mass: 52 bytes a particle.
  const double yardstick = limits().yardstick_ns(simd, work.constraints, 52 * work.particles);
  if (work.particles > 0) state.counters["ns/particle"] = ns / (work.steps * work.particles);
  if (work.constraints > 0) {
    state.counters["ns/constraint"] = ns / (work.steps * work.constraints);
    state.counters["x yardstick"] = ns / (work.steps * yardstick);
  }
}

void register_steps(bool quick) {
  const std::vector<int> sizes =
      quick ? std::vector<int>{32, 100, 316} : std::vector<int>{30, 32, 64, 100, 316, 1000};
  for (const Way& way : kWays)
    for (int n : sizes)
      for (int threads : {1, 2}) add(way, n, widest(), threads);
  for (const Way& way : kWays)
    for (int n : {40, 100})
      for (int threads : {1, 2}) {
        const std::string name = "four/" + std::string(way.name) + "/" + std::to_string(n) +
                                 "/threads:" + std::to_string(threads);
        add_benchmark(name, [=](benchmark::State& s) { step_four(s, way, n, threads); });
      }
  for (const Way& way : kWays)
    for (weft::Simd simd : {weft::Simd::scalar, weft::Simd::sse2, weft::Simd::avx2})
      if (weft::simd_available(simd) && simd != widest())
        for (int n : quick ? std::vector<int>{100} : std::vector<int>{32, 100, 316})
          add(way, n, simd, 1);
}

}  // namespace bench
