// A million particles: one frame, on one thread with narrow kernels and on four with the widest.
#include <gtest/gtest.h>

#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

std::uint64_t hash_after_a_frame(int threads, Simd simd) {
  Options options;
  options.threads = threads;
  options.simd = simd;
  Simulation simulation(read_scene("huge").scene, options);
  simulation.advance_frame();
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  return simulation.hash();
}

TEST(Huge, HasOneResult) {
  EXPECT_EQ(hash_after_a_frame(4, Simd::best), hash_after_a_frame(1, Simd::sse2));
}

}  // namespace
}  // namespace weft
