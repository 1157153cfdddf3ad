// Squares of a surface against each other, kernel by kernel: distances against the same found plainly
// in double precision, for every instruction set and any number of pairs.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "physics/kernels/surface.h"
#include "physics/model/random.h"

namespace weft::physics {
namespace {

using Vector = Eigen::Vector3d;

constexpr int kPadding = 16;
constexpr float kClose = 0.05f, kBeyond = 0.4f, kThickness = 0.3f;

double to_segment(const Vector& p, const Vector& a, const Vector& b) {
  const Vector e = b - a;
  const double t = e.squaredNorm() > 0 ? std::clamp((p - a).dot(e) / e.squaredNorm(), 0.0, 1.0) : 0;
  return (p - a - t * e).norm();
}

double to_triangle(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  double least = std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
  Eigen::Matrix<double, 3, 2> sides;
  sides << b - a, c - a;
  const Eigen::Vector2d share = sides.colPivHouseholderQr().solve(p - a);
  if (share.minCoeff() >= 0 && share.sum() <= 1)
    least = std::min(least, (p - a - sides * share).norm());
  return least;
}

// Nearest within both, or with an end of either.
double between_segments(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
  double least = std::min(
      {to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
  Eigen::Matrix<double, 3, 2> ways;
  ways << b - a, c - d;
  const Eigen::Vector2d share = ways.colPivHouseholderQr().solve(c - a);
  if (share.minCoeff() >= 0 && share.maxCoeff() <= 1)
    least = std::min(least, (a + ways * share - c).norm());
  return least;
}

// Squares at random, each beside the next where they share corners, and all pairs of them.
struct Squares {
  explicit Squares(int count) {
    Random random(std::uint64_t(count), 1);
    const auto next = [&] { return float(random.symmetric()); };
    for (int q = 0; q < count; ++q) {
      Square s{};
      for (int c = 0; c < 4; ++c) {
        if (q % 5 == 4 && c % 2 == 0) {  // with the square before
          s.corner[c] = square.back().corner[c + 1];
          continue;
        }
        Vertex v{};
        for (int k = 0; k < 3; ++k) {
          v.x[k] = next() + (k == 0 ? 0.3f * float(c) : 0);
          v.v[k] = next();
        }
        v.w = (q + c) % 6 == 0 ? 0 : 1 + 0.5f * next();
        s.corner[c] = std::int32_t(vertex.size());
        vertex.push_back(v);
      }
      s.place[0] = float(q / 5 * 100 + q % 5);
      s.thickness = kThickness;
      s.friction = 0.5f;
      square.push_back(s);
    }
    for (int a = 0; a < count; ++a)
      for (int b = a + 1; b < count; ++b) {
        owner.push_back(a);
        neighbour.push_back(b);
      }
    pairs = int(owner.size());
    owner.resize(owner.size() + kPadding);
    neighbour.resize(owner.size());
  }

  Vector at(int q, int corner) const {
    const float* const x = vertex[std::size_t(square[std::size_t(q)].corner[corner])].x;
    return {x[0], x[1], x[2]};
  }
  Vertex& of(std::size_t q, int corner) { return vertex[std::size_t(square[q].corner[corner])]; }
  bool same(int a, int corner, int b, int other) const {
    return square[std::size_t(a)].corner[corner] == square[std::size_t(b)].corner[other];
  }
  // Of what a owns from what b owns, parts that share a corner apart.
  double distance(int a, int b) const {
    constexpr int kFaces[2][3] = {{0, 1, 2}, {1, 3, 2}}, kEdges[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, a}})
      for (const auto& f : kFaces)
        if (!same(p, 0, q, f[0]) && !same(p, 0, q, f[1]) && !same(p, 0, q, f[2]))
          least = std::min(least, to_triangle(at(p, 0), at(q, f[0]), at(q, f[1]), at(q, f[2])));
    for (const auto& e : kEdges)
      for (const auto& f : kEdges)
        if (!same(a, e[0], b, f[0]) && !same(a, e[0], b, f[1]) && !same(a, e[1], b, f[0]) &&
            !same(a, e[1], b, f[1]))
          least =
              std::min(least, between_segments(at(a, e[0]), at(a, e[1]), at(b, f[0]), at(b, f[1])));
    return least;
  }
  double held(int a, int b) const {
    const float apart = square[std::size_t(a)].place[0] - square[std::size_t(b)].place[0];
    return std::abs(apart) < 2.5f ? kClose : kThickness;
  }

  int pairs = 0;
  std::vector<Vertex> vertex;
  std::vector<Square> square;
  std::vector<std::int32_t> owner, neighbour;
};

class Surfaces : public testing::TestWithParam<Simd> {
 protected:
  void SetUp() override {
    if (!simd_available(GetParam())) GTEST_SKIP() << "not on this machine";
  }
  struct Result {
    std::vector<float> near_squared;
    std::vector<SquaresTouching> touching;
  };
  static Result measured(const Squares& s, Simd simd, bool touching = true) {
    Result r;
    r.near_squared.resize(s.owner.size());
    r.touching.resize(s.owner.size());
    const int found = kernel_table(simd).surface_pairs(
        {s.vertex.data(), s.square.data(), s.pairs, s.owner.data(), s.neighbour.data(), kClose,
         kBeyond, r.near_squared.data(), touching ? r.touching.data() : nullptr});
    r.touching.resize(std::size_t(found));
    r.near_squared.resize(std::size_t(s.pairs));
    return r;
  }
};

TEST_P(Surfaces, MeasuresDistancesAndFindsWhatTouches) {
  for (const int count : {2, 3, 7, 30}) {
    const Squares s(count);
    const Result r = measured(s, GetParam());
    std::size_t t = 0;
    for (int k = 0; k < s.pairs; ++k) {
      const int a = s.owner[std::size_t(k)], b = s.neighbour[std::size_t(k)];
      const double distance = s.distance(a, b);
      const float squared = r.near_squared[std::size_t(k)];
      const double reach = s.held(a, b) + kBeyond;
      if (distance < reach - 1e-5) {
        EXPECT_NEAR(std::sqrt(squared), distance, 1e-5) << a << ' ' << b;
      } else if (distance > reach + 1e-5) {
        EXPECT_EQ(squared, kOutOfReach) << a << ' ' << b;
      }
      const bool touches = t < r.touching.size() && r.touching[t].pair == k;
      EXPECT_EQ(touches, distance < s.held(a, b)) << a << ' ' << b;
      t += touches;
    }
    EXPECT_EQ(t, r.touching.size());
    EXPECT_TRUE(count < 30 || t > 10) << t;
    const Result alone = measured(s, GetParam(), false);
    EXPECT_EQ(alone.near_squared, r.near_squared);
    EXPECT_TRUE(alone.touching.empty());
  }
}

// A corner comes down on the middle of a square, across it: what one is pushed and loses, times its
// mass, the other is pushed and gains, whatever their masses and frictions.
TEST_P(Surfaces, PushesBothApartByOneImpulse) {
  Squares s(2);
  const float corners[2][4][3] = {{{0, 0.1f, 0}, {1, 1, 0}, {-1, 1, 1}, {0, 2, 1}},
                                  {{-2, 0, -2}, {3, 0, -2}, {-2, 0, 3}, {3, 0, 3}}};
  for (std::size_t q = 0; q < 2; ++q) {
    s.square[q].place[0] = 100 * float(q);
    s.square[q].friction = 0.2f + 0.4f * float(q);
    for (int c = 0; c < 4; ++c) {
      Vertex& v = s.of(q, c) = {};
      std::copy_n(corners[q][c], 3, v.x);
      v.w = 1 + 0.5f * float(q) + 0.1f * float(c);
      if (q == 0) v.v[0] = 2, v.v[1] = -1;
    }
  }
  const Result r = measured(s, GetParam());
  ASSERT_EQ(r.touching.size(), 1u);
  Vector pushed[2], gained[2];
  for (int n = 0; n < 2; ++n) {
    pushed[n] = gained[n] = Vector::Zero();
    const SquareChange& change = r.touching[0].change[n];
    for (int c = 0; c < 4; ++c) {
      if (change.weight[c] == 0) continue;
      const double of = 1 / (double(change.weight[c]) * s.of(std::size_t(n), c).w);
      for (int k = 0; k < 3; ++k) {
        pushed[n][k] += change.push[c][k] * of;
        gained[n][k] += change.gain[c][k] * of;
      }
    }
  }
  EXPECT_NEAR((pushed[0] + pushed[1]).norm(), 0, 1e-6);
  EXPECT_NEAR((gained[0] + gained[1]).norm(), 0, 1e-5);
  EXPECT_GT(pushed[0].y(), 0.01);
  EXPECT_NEAR(pushed[0].x(), 0, 1e-6);
  EXPECT_GT(gained[0].y(), 0.1);
  EXPECT_NEAR(gained[0].x(), -0.4 * gained[0].y(), 1e-5) << "the mean of both frictions";
  // What is pinned stays where it is.
  for (int c = 0; c < 4; ++c) s.of(1, c).w = 0;
  const SquareChange held = measured(s, GetParam()).touching.at(0).change[1];
  for (const auto& change : {held.push, held.gain})
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k) EXPECT_EQ(change[c][k], 0);
}

TEST_P(Surfaces, HasTheBitsOfTheScalarKernel) {
  const Squares s(30);
  const Result r = measured(s, GetParam()), expected = measured(s, Simd::scalar);
  EXPECT_EQ(r.near_squared, expected.near_squared);
  ASSERT_EQ(r.touching.size(), expected.touching.size());
  for (std::size_t t = 0; t < r.touching.size(); ++t) {
    EXPECT_EQ(r.touching[t].pair, expected.touching[t].pair);
    for (int n = 0; n < 2; ++n) {
      const auto floats = [&](const Result& of) { return &of.touching[t].change[n].push[0][0]; };
      constexpr std::size_t kFloats = sizeof(SquareChange) / sizeof(float);
      EXPECT_TRUE(std::equal(floats(r), floats(r) + kFloats, floats(expected))) << t;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, Surfaces,
                         testing::Values(Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512),
                         [](const auto& test) { return std::string(simd_name(test.param)); });

}  // namespace
}  // namespace weft::physics
