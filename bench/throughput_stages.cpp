// Every stage of the step plans by itself, row after row on one thread: ns per item, whether the
// items are particles or constraints. Built on the library's own headers.
#include <memory>

#include "physics/frame/cloth_step.h"
#include "physics/step/threads.h"
#include "throughput.h"

namespace bench {
namespace {

using weft::physics::ClothStep;

// One cloth's step, kept between repetitions, of which one stage is run again and again.
struct Bench {
  weft::Scene scene;
  weft::Simd simd;
  std::unique_ptr<ClothStep> step;

  Bench(weft::Scene s, weft::Simd simd_) : scene(std::move(s)), simd(simd_) {
    step = std::make_unique<ClothStep>(scene, 0, scene.solver.method, 1,
                                       weft::physics::kernel_table(simd));
    for (const auto& stage : step->stages()) {
      stage->prepare(scene.time.frame / scene.time.substeps);
      if (auto* rows = stage->as_row_stage()) rows->reserve(1);
    }
  }
};

void run_stage(benchmark::State& state, Bench& bench, std::size_t index) {
  auto& stage = *bench.step->stages()[index];
  const int rows = bench.step->particles().rows;
  const double dt = bench.scene.time.frame / bench.scene.time.substeps;
  const weft::physics::Substep substep{dt, dt, dt};
  // Many passes a measurement, so that reading the clock does not count.
  const int passes = 4;
  weft::physics::Threads threads(1);
  auto* row_stage = stage.as_row_stage();
  auto* whole_stage = stage.as_whole_stage();
  const double ns = fastest_ns(state, [&] {
    for (int pass = 0; pass < passes; ++pass) {
      if (row_stage) row_stage->run(0, rows, substep);
      if (whole_stage) whole_stage->run(substep, threads);
    }
  });
  const bool particles = stage.item == "particles";
  count_work(state, bench.simd, ns,
             {passes, particles ? double(stage.items) : 0, particles ? 0 : double(stage.items)});
}

void add_stages(const std::string& name, const weft::Scene& scene, weft::Simd simd) {
  const auto bench = std::make_shared<Bench>(scene, simd);
  const auto& stages = bench->step->stages();
  for (std::size_t q = 0; q < stages.size(); ++q) {
    const std::string full = "stage/" + name + "/" + stages[q]->name + "/" + stages[q]->detail +
                             "/" + weft::simd_name(simd);
    add_benchmark(full, [bench, q](benchmark::State& s) { run_stage(s, *bench, q); });
  }
}

}  // namespace

void register_stages(bool quick) {
  const std::vector<weft::Simd> all =
      quick ? std::vector<weft::Simd>{widest()}
            : std::vector<weft::Simd>{weft::Simd::scalar, weft::Simd::sse2, weft::Simd::avx2,
                                      weft::Simd::avx512};
  for (weft::Simd simd : all) {
    if (!weft::simd_available(simd)) continue;
    weft::Scene scene = stepping_scene(100, 32);
    add_stages("spring", scene, simd);
    scene.cloths[0].stiffness_gradient = 0.4;
    scene.cloths[0].spring_damping = {0.001, 0.001, 0.001};
    scene.solver.method = weft::Method::spring_friction;
    add_stages("spring_friction", scene, simd);
    scene = stepping_scene(100, 32);
    scene.solver.method = weft::Method::compliant;
    add_stages("compliant", scene, simd);
    scene.solver.sweep = weft::Sweep::jacobi;
    add_stages("compliant jacobi", scene, simd);
    for (const int n : {64, 100, 316}) {
      scene = stepping_scene(n, 32);
      scene.time.frame = 32 / 480.0;
      scene.solver.method = weft::Method::compliant;
      scene.solver.sweep = weft::Sweep::line;
      add_stages("compliant line, N=" + std::to_string(n), scene, simd);
    }
  }
}

}  // namespace bench
