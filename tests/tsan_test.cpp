// Small runs on two worker threads, for the thread sanitizer (and quick enough to run anywhere).
#include <gtest/gtest.h>

#include <thread>

#include "weft/simulation.h"

namespace weft {
namespace {

Scene falling_sheet(Method method) {
  Cloth cloth;
  cloth.grid.nx = cloth.grid.ny = 40;
  cloth.pins = {{0, 0, {}}, {39, 0, {}}};
  Scene scene;
  scene.cloths = {cloth};
  scene.solver.method = method;
  scene.time.substeps = 20;
  scene.colliders = {{Sphere{{0.5, -0.2, 0.5}, 0.2}, {}, 0.01, {}, false}};
  return scene;
}

std::uint64_t hash_after(const Scene& scene, int threads) {
  Options options;
  options.threads = threads;
  Simulation simulation(scene, options);
  for (int frame = 0; frame < 3; ++frame) simulation.advance_frame();
  return simulation.hash();
}

TEST(Threads, TwoGiveWhatOneGives) {
  for (const Method method : {Method::spring, Method::compliant, Method::positional}) {
    const Scene scene = falling_sheet(method);
    EXPECT_EQ(hash_after(scene, 2), hash_after(scene, 1));
  }
}

TEST(Threads, TwoSimulationsAtOnceDoNotMeet) {
  const Scene scene = falling_sheet(Method::spring);
  std::uint64_t first = 0;
  std::uint64_t second = 0;
  std::thread one([&] { first = hash_after(scene, 2); });
  std::thread two([&] { second = hash_after(scene, 2); });
  one.join();
  two.join();
  EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace weft
