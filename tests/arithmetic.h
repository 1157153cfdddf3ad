// The arithmetic that kernels are written with, against the standard library's and against double
// precision. A test file defines the width (physics/kernels/wide.h) and includes this.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "physics/kernels/root.h"
#include "weft/random.h"

namespace weft::WEFT_KERNELS {

inline std::uint32_t bits_of(float value) {
  return std::isnan(value) ? 0x7fc00000 : std::bit_cast<std::uint32_t>(value);
}

// All three forms, a + bc fused, against std::fma.
inline void expect_fused(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const float x = std::bit_cast<float>(a), y = std::bit_cast<float>(b), z = std::bit_cast<float>(c);
  const int last = kLanes - 1;
  ASSERT_EQ(bits_of(fma(wide(x), wide(y), wide(z))[last]), bits_of(std::fma(x, y, z)))
      << x << " * " << y << " + " << z;
  ASSERT_EQ(bits_of(fnma(wide(x), wide(y), wide(z))[0]), bits_of(std::fma(-x, y, z)));
  ASSERT_EQ(bits_of(fms(wide(x), wide(y), wide(z))[0]), bits_of(std::fma(x, y, -z)));
}

TEST(Arithmetic, FusedMultiplyAddRoundsOnce) {
  const std::uint32_t special[] = {0,          0x80000000, 1,          0x80000001, 0x007fffff,
                                   0x00800000, 0x33800000, 0xb3800000, 0x3f800000, 0xbf800000,
                                   0x3f800001, 0x7f7fffff, 0xff7fffff, 0x7f800000, 0x7fc00000};
  for (const std::uint32_t a : special)
    for (const std::uint32_t b : special)
      for (const std::uint32_t c : special) expect_fused(a, b, c);
  Random random(3, 1);
  const auto word = [&] { return std::uint32_t(random.bits() >> 32); };
  for (int n = 0; n < 200000; ++n) {
    expect_fused(word(), word(), word());
    // Factors of few bits and close exponents: sums between two floats, where rounding twice shows.
    const auto close = [&](std::uint32_t mask) {
      return (word() & (0x80000000 | mask)) | (100 + word() % 50) << 23;
    };
    expect_fused(close(0x007f0000), close(0x007ff000), close(0x00000fff));
    // Products near the least float.
    const std::uint32_t tiny = word() & 0x807fffff;
    expect_fused(tiny, 0x3f000000 | (word() & 0x007fffff), word() & 0x80ffffff);
  }
}

// Over two octaves, which is all that there are: what is told in root.h, and no worse than the
// division by a root (1.49).
TEST(Arithmetic, ReciprocalRootsAreWithinTheirError) {
  double greatest = 0;
  for (std::uint32_t bits = 0x3f800000; bits < 0x40800000; bits += 3) {
    const float s = std::bit_cast<float>(bits);
    const double exact = 1 / std::sqrt(double(s));
    const float rounded = float(exact);
    const double unit = std::nextafter(rounded, 2.0f) - rounded;
    greatest = std::max(greatest, std::abs(reciprocal_root(wide(s))[0] - exact) / unit);
  }
  EXPECT_LT(greatest, 1.32);
  EXPECT_GT(greatest, 0.5);
  EXPECT_TRUE(std::isfinite(reciprocal_root(wide(0))[0]));
  EXPECT_NEAR(reciprocal_root(wide(1e-30f))[0], 1e15f, 1e8f);
  EXPECT_NEAR(reciprocal_root(wide(1e30f))[0], 1e-15f, 1e-22f);
}

TEST(Arithmetic, MaxAndMinGiveTheSecondWhereOneIsNotANumber) {
  const Wide nan = wide(std::nanf("")), one = wide(1);
  EXPECT_EQ(max(nan, one)[0], 1);
  EXPECT_EQ(min(nan, one)[0], 1);
  EXPECT_TRUE(std::isnan(max(one, nan)[0]));
  EXPECT_TRUE(std::isnan(min(one, nan)[0]));
}

TEST(Arithmetic, WholeNumbersOfAnyFloatAreInRange) {
  constexpr int kMost = 1 << 30;
  const float values[] = {0, -0.0f, 1.75f, -1.75f, 3e9f, -3e9f, INFINITY, -INFINITY};
  const int expected[] = {0, 0, 1, -1, kMost, -kMost, kMost, -kMost};
  for (std::size_t n = 0; n < std::size(values); ++n)
    EXPECT_EQ(whole(wide(values[n]))[kLanes - 1], expected[n]) << values[n];
  EXPECT_EQ(std::abs(whole(wide(std::nanf("")))[0]), kMost);
}

// Masks that are combined, kept through a loop and chosen by, as the descent on triangles does
// (collide.h): compilers have got this wrong for one lane.
inline float descend_wide(float bound, float enough, float start, float least, int count) {
  Wide b = wide(bound), q = wide(start);
  WideInt pending = lanes_below(count) & (b < enough);
  for (int n = 0; any(pending); ++n) {
    const Wide s = q * 0.5f - 0.1f;
    b = select(pending, max(s, b), b);
    pending = pending & (b < enough);
    if (n == 5 || !any(pending)) break;
    q = q - max(s, wide(least));
  }
  return select((b >= 0.0f) & (q >= 0.0f) & (b + q <= 1.0f), b, q)[0];
}
inline float descend_plain(float b, float enough, float q, float least, int count) {
  bool pending = 0 < count && b < enough;
  for (int n = 0; pending; ++n) {
    const float s = q * 0.5f - 0.1f;
    if (s > b) b = s;
    pending = b < enough;
    if (n == 5 || !pending) break;
    q = q - (s > least ? s : least);
  }
  return b >= 0 && q >= 0 && b + q <= 1 ? b : q;
}

TEST(Arithmetic, MasksHoldThroughLoops) {
  Random random(5, 1);
  const auto number = [&] { return float(2 * random.symmetric()); };
  for (int n = 0; n < 20000; ++n) {
    const float bound = number(), enough = number(), start = number(), least = number();
    for (int count = 0; count < 3; ++count)
      ASSERT_EQ(bits_of(descend_wide(bound, enough, start, least, count)),
                bits_of(descend_plain(bound, enough, start, least, count)))
          << bound << " " << enough << " " << start << " " << least << " " << count;
  }
}

}  // namespace weft::WEFT_KERNELS
