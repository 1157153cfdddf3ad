// Meshes whose membrane is solved by method compliant, and how far states are apart.
#pragma once

#include <gtest/gtest.h>

#include "mesh_scenes.h"
#include "weft/vec3.h"

namespace weft {

inline constexpr Sweep kSweeps[] = {Sweep::gauss_seidel, Sweep::line};
inline constexpr Membrane kIsotropic{1500, 1500, 500, 500, 0}, kDamped{3000, 2000, 200, 80, 2e-3};

inline Scene projected(std::shared_ptr<const TriangleMesh> mesh, const Membrane& membrane,
                       int order, int substeps, int iterations = 1) {
  Scene scene = scene_of(std::move(mesh));
  scene.solver.method = Method::compliant;
  scene.solver.order = order;
  scene.solver.iterations = iterations;
  scene.time.substeps = substeps;
  scene.cloths[0].membrane = membrane;
  return scene;
}

inline Scene by_forces(Scene scene) {
  scene.solver = {};
  scene.time.substeps = kAutoSubsteps;
  scene.time.substeps = 2 * Simulation(scene, {.threads = 1}).substeps();
  return scene;
}

// Held along one side, which it swings about, with a load across.
inline Scene curtain(int n, const Membrane& membrane, int order, int substeps, int iterations = 1) {
  Scene scene =
      projected(made_up({.nx = n, .ny = n, .shift = 0.2}), membrane, order, substeps, iterations);
  scene.gravity = {2, -9, 3};
  scene.cloths[0].bending = 2e-4;
  scene.cloths[0].drag = 1;
  for (int j = 0; j < n; ++j) scene.cloths[0].pins.push_back({j * n, 0, {}});
  return scene;
}

inline std::vector<Vec3> after(const Scene& scene, int frames) {
  Simulation run(scene, {.threads = 1});
  for (int n = 0; n < frames; ++n) run.advance_frame();
  EXPECT_TRUE(run.status().ok) << run.status().text;
  EXPECT_FALSE(run.plan().fallback);
  return positions_of(run);
}

// Root mean square [m].
inline double apart(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const Vec3 e = minus(a[n], b[n]);
    sum += dot(e, e) / double(a.size());
  }
  return std::sqrt(sum);
}
}  // namespace weft
