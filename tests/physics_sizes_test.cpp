// What the end of a frame asks of a whole state: greatest size, energy, longest constraint
// (kernels/sizes.cpp), on every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "physics/kernels/kernels.h"
#include "physics/kernels/lattice.h"
#include "physics/model/lattice/lattice.h"
#include "physics/model/lattice/stencil.h"
#include "weft/random.h"

namespace weft::physics {
namespace {

class Sizes : public testing::TestWithParam<Simd> {};

// Every lane and every place counts, the sign does not, and what is no number is infinite.
TEST_P(Sizes, FindTheGreatestSize) {
  if (!simd_available(GetParam())) GTEST_SKIP() << "not on this machine";
  const auto greatest = kernel_table(GetParam()).particles.greatest;
  EXPECT_EQ(greatest(nullptr, 0), 0.0f);
  for (const int count : {16, 48, 64, 208}) {
    AlignedArray<float> values(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.5f - float(i % 3) * 0.4f;
    EXPECT_EQ(greatest(values.data(), count), 0.5f);
    for (std::size_t i = 0; i < values.size(); ++i)
      for (const float odd : {3.0f, -1e30f, std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::quiet_NaN()}) {
        const float before = std::exchange(values[i], odd);
        const float expected = std::isnan(odd) ? std::numeric_limits<float>::infinity() : odd;
        EXPECT_EQ(greatest(values.data(), count), std::fabs(expected)) << i << " of " << count;
        values[i] = before;
      }
  }
}

TEST_P(Sizes, TallyARow) {
  if (!simd_available(GetParam())) GTEST_SKIP() << "not on this machine";
  Rows x(1, 112), v(1, 112);
  AlignedArray<float> w(112);
  Random random(7, 3);
  EnergyRow r{};
  r.x = x.row(0);
  r.v = v.row(0);
  r.w = w.data();
  const Vec3 g{1, -9.81, 0.5};
  for (int k = 0; k < 3; ++k) r.g[k] = g[k];
  for (const int columns : {0, 1, 16, 31, 96}) {
    double kinetic = 0, potential = 0, size = 0;
    float greatest = 0;
    std::fill_n(w.data(), w.size(), 0.0f);
    for (int i = 0; i < columns; ++i) {
      if (i % 5 > 0) w[std::size_t(i)] = float(50 + 40 * random.symmetric());
      const double mass = w[std::size_t(i)] > 0 ? 1 / double(w[std::size_t(i)]) : 0;
      for (int k = 0; k < 3; ++k) {
        x.at(k, 0, i) = float(random.symmetric());
        v.at(k, 0, i) = float(random.symmetric());
        greatest = std::max(greatest, std::abs(x.at(k, 0, i)));
        kinetic += 0.5 * mass * v.at(k, 0, i) * v.at(k, 0, i);
        potential -= mass * g[k] * x.at(k, 0, i);
        size += mass * std::abs(g[k] * x.at(k, 0, i));
      }
    }
    r.columns = columns;
    const EnergySum got = kernel_table(GetParam()).particles.energy_sum(r);
    const EnergySum scalar = kernel_table(Simd::scalar).particles.energy_sum(r);
    EXPECT_EQ(got.kinetic, scalar.kinetic);
    EXPECT_EQ(got.potential, scalar.potential);
    EXPECT_NEAR(got.kinetic, kinetic, 2e-7 * kinetic);
    EXPECT_NEAR(got.potential, potential, 1e-7 * size);
    EXPECT_EQ(got.greatest, greatest);
  }
}

TEST_P(Sizes, FindTheLongestConstraintThatIsLeft) {
  if (!simd_available(GetParam())) GTEST_SKIP() << "not on this machine";
  const auto longest = kernel_table(GetParam()).lattice.greatest_square;
  Rows x(2, 96);
  Random random(9, 1);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 96; ++i) x.at(k, j, i) = float(random.symmetric());
  for (const int count : {1, 15, 16, 17, 79})
    for (const int shift : {0, 1}) {
      Links links(1, 96, count);
      for (int left = count; left >= 0; left -= count > 20 ? 7 : 1) {
        float expected = 0;
        for (int i = 0; i < count; ++i) {
          float squared = 0;
          for (int k = 0; k < 3; ++k) {
            const float e = x.at(k, 1, i + shift) - x.at(k, 0, i);
            squared = k == 0 ? e * e : std::fma(e, e, squared);
          }
          links.row(0)[i] = i * 5 % count < left ? -1 : 0;
          if (links.alive(0, i)) expected = std::max(expected, squared);
        }
        EXPECT_EQ(longest({count, x.row(0), ConstRow3(x.row(1)).from(shift), links.row(0)}),
                  expected);
        if (left < count) continue;
        EXPECT_EQ(longest({count, x.row(0), ConstRow3(x.row(1)).from(shift), nullptr}), expected);
      }
    }
}

TEST_P(Sizes, CountWhatConstraintsHold) {
  if (!simd_available(GetParam())) GTEST_SKIP() << "not on this machine";
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  Rows x(2, 96);
  AlignedArray<float> w(2 * 96);
  Random random(5, 2);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 96; ++i) {
      for (int k = 0; k < 3; ++k) x.at(k, j, i) = float(random.symmetric());
      w[std::size_t(96 * j + i)] = i % 3 == 0 ? 0 : float(2 + random.symmetric());
    }
  Links links(1, 96, 79);
  for (int i = 0; i < 79; ++i) links.row(0)[i] = i % 7 > 1 ? -1 : 0;
  StretchRow r{};
  r.near = x.row(0);
  r.far = ConstRow3(x.row(1)).from(1);
  r.w_near = w.data();
  r.w_far = w.data() + 97;
  r.rest = 0.8f;
  r.slack = 0.01f;
  r.inverse_dt2 = 100;
  for (const int count : {0, 1, 15, 16, 17, 79})
    for (const float stiffness : {10.0f, 40.0f, kInfinite})
      for (const float share : {0.3f, 1.0f, kInfinite})
        for (const float give : {0.0f, 0.2f, kInfinite})
          for (std::int32_t* alive : {links.row(0), static_cast<std::int32_t*>(nullptr)}) {
            if (stiffness == kInfinite && share == kInfinite) continue;
            r.count = count;
            r.stiffness = stiffness;
            r.share = share;
            r.give = give;
            r.alive = alive;
            double expected = 0;
            for (int i = 0; i < count; ++i) {
              const double inverse = double(r.w_near[i]) + r.w_far[i];
              if (inverse == 0 || (alive && alive[i] == 0)) continue;
              double squared = 0;
              for (int k = 0; k < 3; ++k)
                squared += std::pow(double(x.at(k, 1, i + 1)) - x.at(k, 0, i), 2);
              const double off = std::abs(std::sqrt(squared) - r.rest) + r.slack;
              const double over = std::max(0.0, off - give), rigid = 100 / inverse;
              expected += 0.5 * std::min<double>(stiffness, share * rigid) * off * off;
              expected += 0.5 * rigid * over * over;
            }
            const double got = kernel_table(GetParam()).lattice.stretch_energy(r);
            EXPECT_EQ(got, kernel_table(Simd::scalar).lattice.stretch_energy(r));
            EXPECT_NEAR(got, expected, 1e-6 * expected);
          }
}

INSTANTIATE_TEST_SUITE_P(, Sizes, testing::Values(Simd::sse2, Simd::avx2, Simd::avx512),
                         [](const auto& test) { return simd_name(test.param); });

}  // namespace
}  // namespace weft::physics
