// Squares of a surface against each other, kernel by kernel: contacts, what may pass and what a plane keeps
// apart, against distances found plainly in double precision, for every instruction set and any number
// of pairs.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "physics/kernels/kernels.h"
#include "physics/kernels/surface.h"
#include "weft/random.h"

namespace weft::physics {
namespace {

using Vector = Eigen::Vector3d;

constexpr int kPadding = 16;
constexpr float kThickness = 0.3f, kMoved = 0.5f, kFloor = 0.02f;  // m, m, of the thickness

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

// Squares at random, each beside the next where they share corners, all pairs of them, and how they move.
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
        Place x{};
        Displacement u{};
        for (int k = 0; k < 3; ++k) {
          x.x[k] = next() + (k == 0 ? 0.3f * float(c) : 0);
          u.u[k] = kMoved * next();
        }
        x.x[3] = kThickness / 2;
        u.u[3] = (q + c) % 6 == 0 ? 0 : 1 + 0.5f * next();
        s.corner[c] = std::int32_t(place.size());
        place.push_back(x);
        moved.push_back(u);
        rest.push_back({0, 0, 0, float(q)});  // each a sheet of its own
      }
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

  Vector at(int q, int corner, double time = 0) const {
    return body(square[std::size_t(q)].corner[corner], time);
  }
  Vector body(std::int32_t n, double time = 0) const {
    const float *const x = place[std::size_t(n)].x, *const u = moved[std::size_t(n)].u;
    return {x[0] + time * u[0], x[1] + time * u[1], x[2] + time * u[2]};
  }
  bool same(int a, int corner, int b, int other) const {
    return square[std::size_t(a)].corner[corner] == square[std::size_t(b)].corner[other];
  }
  // Of what a owns from what b owns, parts that share a corner apart.
  double distance(int a, int b, double time = 0) const {
    constexpr int kFaces[2][3] = {{0, 1, 2}, {1, 3, 2}}, kEdges[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, a}})
      for (const auto& f : kFaces)
        if (!same(p, 0, q, f[0]) && !same(p, 0, q, f[1]) && !same(p, 0, q, f[2]))
          least = std::min(least, to_triangle(at(p, 0, time), at(q, f[0], time), at(q, f[1], time),
                                              at(q, f[2], time)));
    for (const auto& e : kEdges)
      for (const auto& f : kEdges)
        if (!same(a, e[0], b, f[0]) && !same(a, e[0], b, f[1]) && !same(a, e[1], b, f[0]) &&
            !same(a, e[1], b, f[1]))
          least = std::min(least, between_segments(at(a, e[0], time), at(a, e[1], time),
                                                   at(b, f[0], time), at(b, f[1], time)));
    return least;
  }

  int pairs = 0;
  std::vector<Place> place;
  std::vector<Displacement> moved;
  std::vector<RestPlace> rest;
  std::vector<Square> square;
  std::vector<std::int32_t> owner, neighbour;
};

class Surfaces : public testing::TestWithParam<Simd> {
 protected:
  void SetUp() override {
    if (!simd_available(GetParam())) GTEST_SKIP() << "not on this machine";
  }
  static std::vector<SurfaceContact> found(const Squares& s, Simd simd, SurfaceSearch search) {
    std::vector<SurfaceContact> room(s.owner.size() * kKindsOfPair);
    const int count = kernel_table(simd).sheets.surface_pairs(
        {s.place.data(), s.moved.data(), s.rest.data(), s.square.data(), s.pairs, s.owner.data(),
         s.neighbour.data(), search, 1, kFloor, room.data()});
    room.resize(std::size_t(count));
    return room;
  }
  static std::vector<int> not_apart(const Squares& s, Simd simd, float range) {
    std::vector<std::int32_t> owner(s.owner.size()), neighbour(s.owner.size());
    const int count = kernel_table(simd).sheets.squares_not_apart(
        {s.place.data(), s.moved.data(), s.square.data(), s.pairs, s.owner.data(),
         s.neighbour.data(), range, owner.data(), neighbour.data()});
    std::vector<int> pairs;
    for (int k = 0, at = 0; k < s.pairs && at < count; ++k)
      if (s.owner[std::size_t(k)] == owner[std::size_t(at)] &&
          s.neighbour[std::size_t(k)] == neighbour[std::size_t(at)]) {
        pairs.push_back(k);
        ++at;
      }
    EXPECT_EQ(int(pairs.size()), count) << "pairs keep their order";
    return pairs;
  }
};

TEST_P(Surfaces, ContactsAreAsFarApartAsTheySay) {
  std::size_t all = 0;
  for (const int count : {2, 3, 7, 30}) {
    const Squares s(count);
    for (const SurfaceContact& c : found(s, GetParam(), SurfaceSearch::contacts)) {
      Vector off = Vector::Zero();
      double sum = 0;
      for (int b = 0; b < 4; ++b) {
        off += double(c.share[b]) * s.body(c.body[b]);
        sum += double(c.share[b]);
      }
      const Vector normal(c.normal[0], c.normal[1], c.normal[2]);
      EXPECT_NEAR(sum, 0, 1e-5);
      EXPECT_NEAR(off.norm(), c.distance, 2e-5);
      EXPECT_NEAR(off.dot(normal), c.distance, 2e-5);
      const auto k = std::size_t(c.pair);
      // (A vertex counts as above a triangle a little beside it, too.)
      EXPECT_GE(c.distance, s.distance(s.owner[k], s.neighbour[k]) - 0.05);
      ++all;
    }
  }
  EXPECT_GT(all, 50u);
}

TEST_P(Surfaces, WhatIsTooCloseAtTheStartIsFoundWhateverMoves) {
  Squares s(30);
  for (Displacement& u : s.moved) u.u[0] = u.u[1] = u.u[2] = 0;
  const auto contacts = found(s, GetParam(), SurfaceSearch::contacts);
  for (const SurfaceContact& c : contacts) EXPECT_LT(c.distance, kThickness);
  EXPECT_GT(contacts.size(), 50u);
  EXPECT_TRUE(found(s, GetParam(), SurfaceSearch::passing).empty()) << "nothing moves";
}

TEST_P(Surfaces, WhatPassesIsFound) {
  const Squares s(30);
  std::vector<bool> named(std::size_t(s.pairs));
  for (const SurfaceContact& c : found(s, GetParam(), SurfaceSearch::passing))
    named[std::size_t(c.pair)] = true;
  int touching = 0;
  for (int k = 0; k < s.pairs; ++k) {
    const int a = s.owner[std::size_t(k)], b = s.neighbour[std::size_t(k)];
    double least = s.distance(a, b);
    const double start = least;
    for (double time = 0.01; time <= 1; time += 0.01)
      least = std::min(least, s.distance(a, b, time));
    if (least > 1e-3 || start < 1e-2) continue;
    ++touching;
    EXPECT_TRUE(named[std::size_t(k)]) << a << ' ' << b << " start " << start;
  }
  EXPECT_GT(touching, 0);
}

TEST_P(Surfaces, WhatComesNearIsNotLeftOut) {
  constexpr float kRange = 0.05f;
  const Squares s(30);
  const std::vector<int> near = not_apart(s, GetParam(), kRange);
  EXPECT_LT(int(near.size()), s.pairs) << "some are apart";
  for (int k = 0; k < s.pairs; ++k) {
    double least = std::numeric_limits<double>::infinity();
    for (double time = 0; time <= 1; time += 0.05)
      least =
          std::min(least, s.distance(s.owner[std::size_t(k)], s.neighbour[std::size_t(k)], time));
    EXPECT_TRUE(least >= kRange || std::binary_search(near.begin(), near.end(), k)) << k;
  }
}

TEST_P(Surfaces, HasTheBitsOfTheScalarKernel) {
  const Squares s(30);
  for (const SurfaceSearch search : {SurfaceSearch::contacts, SurfaceSearch::passing}) {
    const auto order = [](std::vector<SurfaceContact> of) {
      std::sort(of.begin(), of.end(), [](const SurfaceContact& a, const SurfaceContact& b) {
        return a.pair != b.pair ? a.pair < b.pair : a.kind < b.kind;
      });
      return of;
    };
    const auto one = order(found(s, GetParam(), search)),
               other = order(found(s, Simd::scalar, search));
    ASSERT_EQ(one.size(), other.size());
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(SurfaceContact)), 0);
  }
  EXPECT_EQ(not_apart(s, GetParam(), 0.05f), not_apart(s, Simd::scalar, 0.05f));
}

INSTANTIATE_TEST_SUITE_P(, Surfaces,
                         testing::Values(Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512),
                         [](const auto& test) { return std::string(simd_name(test.param)); });

}  // namespace
}  // namespace weft::physics
