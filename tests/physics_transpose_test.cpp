// Rows turned into lanes, and back: written over, or added to the rows and in proportion to their
// rates, for every instruction set and number of rows and columns.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "physics/kernels/kernels.h"
#include "physics/kernels/line.h"
#include "physics/kernels/transpose.h"
#include "weft/random.h"

namespace weft::physics {
namespace {

constexpr int kStride = 48, kPitch = 32, kMostRows = 16;

std::vector<float> random_floats(std::size_t count, std::uint64_t seed) {
  Random random(seed, 0);
  std::vector<float> values(count);
  for (float& v : values) v = float(random.symmetric());
  return values;
}

class Transposing : public testing::TestWithParam<Simd> {
 protected:
  void SetUp() override {
    if (!simd_available(GetParam())) GTEST_SKIP() << "not on this machine";
  }
  const KernelTable& kernels() const { return kernel_table(GetParam()); }

  // Calls check(t) for all shapes; room for whole tiles of columns beyond the last.
  template <class Check>
  void for_all_shapes(const Check& check) {
    for (int rows = 1; rows <= kMostRows; ++rows)
      for (const int columns : {1, 3, 4, 5, 16, 31, 44}) {
        TransposeRows t{};
        t.stride = kStride;
        t.pitch = kPitch;
        t.row_count = rows;
        t.columns = columns;
        SCOPED_TRACE(testing::Message() << rows << " rows of " << columns);
        check(t);
      }
  }
  std::vector<float> rows_ = random_floats(kMostRows * kStride, 1);
  std::vector<float> added_ = random_floats(kMostRows * kStride, 2);
  std::vector<float> lanes_ = random_floats(physics::turned_columns(kStride) * kPitch, 3);
};

TEST_P(Transposing, PutsRowsIntoLanes) {
  for (const bool adds : {false, true})
    for_all_shapes([&](TransposeRows t) {
      std::vector<float> rows = rows_, lanes = lanes_;
      t.rows = rows.data();
      t.added = adds ? added_.data() : nullptr;
      t.lanes = lanes.data();
      kernels().lines.rows_to_lanes(t);
      EXPECT_EQ(rows, rows_);
      for (int r = 0; r < t.row_count; ++r)
        for (int i = 0; i < t.columns; ++i) {
          const auto at = std::size_t(r * kStride + i);
          ASSERT_EQ(lanes[std::size_t(i * kPitch + r)], adds ? rows_[at] + added_[at] : rows_[at]);
        }
    });
}

TEST_P(Transposing, AddsLanesToRowsAndToNothingElse) {
  for_all_shapes([&](TransposeRows t) {
    std::vector<float> rows = rows_, lanes = lanes_, expected = rows_;
    t.rows = rows.data();
    t.lanes = lanes.data();
    kernels().lines.lanes_to_rows(t);
    EXPECT_EQ(lanes, lanes_);
    for (int r = 0; r < t.row_count; ++r)
      for (int i = 0; i < t.columns; ++i)
        expected[std::size_t(r * kStride + i)] += lanes_[std::size_t(i * kPitch + r)];
    ASSERT_EQ(rows, expected);
  });
}

INSTANTIATE_TEST_SUITE_P(, Transposing,
                         testing::Values(Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512),
                         [](const auto& test) { return std::string(simd_name(test.param)); });

}  // namespace
}  // namespace weft::physics
