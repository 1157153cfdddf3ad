// Random scenes of sheets that meet keep the laws of contact (bench/meetings.h; `bench/contact --random
// N` runs many more).
#include <gtest/gtest.h>

#include "../bench/meetings.h"
#include "cases.h"

namespace weft {
namespace {

class Meetings : public testing::TestWithParam<int> {};

TEST_P(Meetings, KeepTheLaws) {
  constexpr int kEach = 40;
  Cases cases(3);
  for (int n = kEach * GetParam(); n < kEach * (GetParam() + 1); ++n) {
    if (!cases.next()) continue;
    const Scene scene = bench::random_meeting(std::uint64_t(n));
    EXPECT_EQ(bench::broken_laws(scene, bench::run_meeting(scene, 1)), "")
        << n << ": " << bench::meeting_name(scene);
  }
}

INSTANTIATE_TEST_SUITE_P(Random, Meetings, testing::Range(0, 6));

}  // namespace
}  // namespace weft
