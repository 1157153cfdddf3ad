// A step allocates nothing after the first frame: this program counts every allocation of the whole
// process, made by operator new, malloc or a library.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>

#include "weft/read_scene.h"
#include "weft/simulation.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define WEFT_COUNTS_ALLOCATIONS 0  // the sanitizers bring their own malloc
#else
#define WEFT_COUNTS_ALLOCATIONS 1
#endif

namespace {
std::atomic<std::int64_t> allocations{0};
}  // namespace

#if WEFT_COUNTS_ALLOCATIONS
// glibc's own functions under the names that it keeps for replacements.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  ++allocations;
  return __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  *result = memalign(alignment, size);
  return *result ? 0 : ENOMEM;
}
}
#endif

namespace weft {
namespace {

// Allocations during `frames` frames, after `warm_up`.
std::int64_t allocations_of(const Scene& scene, int threads, int warm_up, int frames) {
  Options options;
  options.threads = threads;
  Simulation simulation(scene, options);
  for (int frame = 0; frame < warm_up; ++frame) simulation.advance_frame();
  const std::int64_t before = allocations;
  for (int frame = 0; frame < frames; ++frame) simulation.advance_frame();
  const std::int64_t made = allocations - before;
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  return made;
}

class Allocation : public testing::Test {
 protected:
  void SetUp() override {
    if (!WEFT_COUNTS_ALLOCATIONS) GTEST_SKIP() << "the sanitizers bring their own malloc";
  }
};

TEST_F(Allocation, IsCounted) {
  const std::int64_t before = allocations;
  auto* volatile kept = new std::vector<double>(100);
  EXPECT_GE(allocations - before, 2);
  delete kept;
}

// What is left out: lists of pairs, which grow as layers meet, and a million particles.
bool counted(const Scene& scene) {
  return scene.name != "huge" && std::all_of(scene.cloths.begin(), scene.cloths.end(), [](auto& c) {
           return c.self_collision.mode == SelfCollisionMode::off && c.tear_strain == 0;
         });
}

TEST_F(Allocation, NoneByTheShippedScenesOnOneThread) {
  int scenes = 0;
  for (const ShippedScene& shipped : shipped_scenes()) {
    const Scene scene = read_scene(shipped.name).scene;
    if (!counted(scene)) continue;
    EXPECT_EQ(allocations_of(scene, 1, 1, 12), 0) << shipped.name;
    ++scenes;
  }
  EXPECT_GE(scenes, 10);
}

Scene stretching_sheet(Method method, Sweep sweep) {
  Scene scene;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid.nx = cloth.grid.ny = 80;
  cloth.stiffness = {200, 100, 20};
  cloth.strain_limit = method == Method::spring_friction ? 0.1 : 0;
  cloth.pins = {{0, 0, {}}, {79, 0, {}}};
  scene.solver = {method, sweep, false, 1, 3, 1};
  scene.time = {0.01, kAutoSubsteps, 1};
  return scene;
}

// A hanging sheet stretches, and its substeps with it, again and again.
TEST_F(Allocation, NoneByAnyMethodOnOneThread) {
  using enum Method;
  using enum Sweep;
  EXPECT_EQ(allocations_of(stretching_sheet(spring, gauss_seidel), 1, 1, 40), 0);
  EXPECT_EQ(allocations_of(stretching_sheet(spring_friction, gauss_seidel), 1, 1, 40), 0);
  for (const Sweep sweep : {gauss_seidel, jacobi}) {
    EXPECT_EQ(allocations_of(stretching_sheet(positional, sweep), 1, 1, 20), 0);
    EXPECT_EQ(allocations_of(stretching_sheet(compliant, sweep), 1, 1, 20), 0);
  }
}

TEST_F(Allocation, NoneWhenTheRunIsLongerThanTheSceneSays) {
  Scene scene = read_scene("hello").scene;
  scene.cloths[0].grid.nx = scene.cloths[0].grid.ny = 8;
  scene.cloths[0].self_collision.mode = SelfCollisionMode::off;
  scene.time.seconds = 5 * scene.time.frame;
  EXPECT_EQ(allocations_of(scene, 1, 1, 60), 0);
}

// oneTBB's pool of tasks grows when its threads meet in a way they never did before: of a few runs
// one must be free of any allocation, which none is that allocates by itself.
TEST_F(Allocation, OfTwoThreads) {
  const Scene scene = stretching_sheet(Method::positional, Sweep::gauss_seidel);
  std::int64_t fewest = 1;
  for (int run = 0; run < 4 && fewest > 0; ++run) {
    fewest = std::min(fewest, allocations_of(scene, 2, 20, 100));
    std::printf("two threads: %lld allocations in 100 frames\n", static_cast<long long>(fewest));
  }
  EXPECT_EQ(fewest, 0);
}

}  // namespace
}  // namespace weft
