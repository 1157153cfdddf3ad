// What the kernel of springs is told, and tells, of whole rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel_patch.h"

namespace weft::physics {
namespace {

// Whether row j of the patch has a spring that is not torn and longer than `length`.
bool has_longer(const Patch& p, int j, double length) {
  const int offsets[kPlainStencils][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {2, 0}, {0, 2}};
  for (int f = 0; f < kPlainStencils; ++f) {
    const auto [di, dj] = offsets[f];
    for (int a = 0; a + std::abs(di) < p.columns && j + dj < kRows; ++a) {
      const int near = a + std::max(0, -di), far = near + di;
      double square = 0;
      for (int axis = 0; axis < 3; ++axis)
        square += std::pow(double(p.x.at(axis, j + dj, far)) - p.x.at(axis, j, near), 2);
      if (p.alive[std::size_t(f * kRows + j) * p.stride + a] && std::sqrt(square) > length)
        return true;
    }
  }
  return false;
}

TEST(SpringRows, TellWhichRowsHaveOverlongOnes) {
  int told = 0, asked = 0;
  for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512}) {
    if (!simd_available(simd)) continue;
    for (int columns = 2; columns <= 70; ++columns)
      for (const float length : {2.0f, 3.0f, 3.5f, 4.0f})
        for (const bool damped : {false, true}) {
          const Patch before(columns, 7.5f);
          Patch patch(columns, 7.5f);
          std::uint8_t overlong[kRows] = {};
          spring_rows(kernel_table(simd), patch, damped, true, 0, kRows, length, overlong);
          for (int j = 0; j < kRows; ++j) {
            ASSERT_EQ(bool(overlong[j]), has_longer(before, j, length))
                << simd_name(simd) << ", " << columns << " columns, row " << j << ", " << length;
            told += overlong[j];
            ++asked;
          }
        }
  }
  EXPECT_GT(told, asked / 10);
  EXPECT_LT(told, asked - asked / 10);
}

TEST(SpringRows, KnowRowsOfOneInverseMass) {
  for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512}) {
    if (!simd_available(simd)) continue;
    for (int columns = 2; columns <= 70; ++columns)
      for (const bool damped : {false, true}) {
        Patch told(columns, 7.5f), untold(columns, 7.5f);
        for (Patch* p : {&told, &untold}) {
          p->weigh_alike();
          for (int j = 0; j < kRows; ++j)
            for (float* v : {p->v.row(j).x, p->v.row(j).y, p->v.row(j).z})
              std::fill(v + columns, v + p->stride, 0.0f);
        }
        spring_rows(kernel_table(simd), told, damped, false, 0, kRows, 0, nullptr, 0.8f);
        spring_rows(kernel_table(simd), untold, damped, false, 0, kRows);
        bool numbers = true;
        ASSERT_EQ(told.bits(numbers), untold.bits(numbers)) << simd_name(simd) << ", " << columns;
        for (int j = 0; j < kRows; ++j)
          for (int i = columns; i < told.stride; ++i)
            for (int axis = 0; axis < 3; ++axis) {
              ASSERT_EQ(told.v.at(axis, j, i), 0.0f) << "padding moves";
              ASSERT_EQ(told.x.at(axis, j, i), 7.5f) << "padding moves";
            }
      }
  }
}

}  // namespace
}  // namespace weft::physics
