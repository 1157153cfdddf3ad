// Pushing pairs apart, kernel by kernel: against the same said plainly in double precision, for every
// instruction set, any numbers of pairs and both rules.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/kernels/contact.h"
#include "physics/random.h"

namespace weft::physics {
namespace {

constexpr int kPadding = 32;
constexpr float kDistance = 0.6f;

struct Pairs {
  std::vector<std::int32_t> owner, neighbour;
};

// Bodies at random in a cube of side 2, some of them pinned, some at the same place, and all ordered pairs
// of the first `owners` with any.
struct Crowd {
  Crowd(int count, int owners, bool course) : owners(owners) {
    Random random(std::uint64_t(count), 0);
    const auto next = [&] { return float(random.symmetric()); };
    for (int a = 0; a < count; ++a) {
      bodies.push_back({{next(), next(), next(), kDistance * (1 + 0.2f * next())},
                        {next(), next(), next(), a % 7 == 3 ? 0 : 1 + 0.5f * next()}});
      friction.push_back(course ? kCourseRule : a % 3 == 0 ? 0 : 0.5f * std::abs(next()));
    }
    if (count > 8) std::copy_n(bodies[2].x, 3, bodies[5].x);
    for (int a = 0; a < owners; ++a)
      for (int b = 0; b < count; ++b) {
        if (b == a) continue;
        pairs.owner.push_back(a);
        pairs.neighbour.push_back(b);
      }
    count_pairs = int(pairs.owner.size());
    pairs.owner.resize(pairs.owner.size() + kPadding);
    pairs.neighbour.resize(pairs.owner.size());
  }
  bool near(int a, int b, double reach) const {
    const Body &p = bodies[std::size_t(a)], &q = bodies[std::size_t(b)];
    return std::hypot(double(p.x[0]) - q.x[0], double(p.x[1]) - q.x[1], double(p.x[2]) - q.x[2]) <
           reach * 0.5 * (double(p.x[3]) + q.x[3]);
  }

  int owners, count_pairs;
  std::vector<Body> bodies;
  std::vector<float> friction;
  Pairs pairs;
};

// What the rules at the top of kernels/separate.cpp make of an owner.
Body plainly(const Crowd& crowd, int a, double course_share, double inverse_dt) {
  const Body& p = crowd.bodies[std::size_t(a)];
  const bool course = crowd.friction[std::size_t(a)] < 0;
  double push[3] = {}, gain[3] = {}, weight = 0;
  for (int b = 0; b < int(crowd.bodies.size()); ++b) {
    if (b == a || !crowd.near(a, b, 1)) continue;
    const Body& q = crowd.bodies[std::size_t(b)];
    double n[3], u[3], distance = 0, into = 0, sliding = 0;
    for (int k = 0; k < 3; ++k) {
      n[k] = double(p.x[k]) - q.x[k];
      u[k] = double(p.v[k]) - q.v[k];
      distance += n[k] * n[k];
    }
    distance = std::sqrt(distance);
    for (int k = 0; k < 3; ++k) n[k] = distance > 0 ? n[k] / distance : k != 1 ? 0 : b > a ? 1 : -1;
    for (int k = 0; k < 3; ++k) into += u[k] * n[k];
    for (int k = 0; k < 3; ++k) sliding += (u[k] - into * n[k]) * (u[k] - into * n[k]);
    sliding = std::sqrt(sliding);
    const double held = 0.5 * (double(p.x[3]) + q.x[3]), depth = held - distance;
    const double lost = std::max(0.0, -into), share = double(p.v[3]) / (double(p.v[3]) + q.v[3]);
    const double friction =
        0.5 * (double(crowd.friction[std::size_t(a)]) + crowd.friction[std::size_t(b)]);
    const double rubbed = std::min(1.0, friction * lost / sliding);
    const double w = course ? 1 : depth;
    weight += w;
    for (int k = 0; k < 3; ++k) {
      push[k] += n[k] * w * (course ? depth : std::min(depth, 0.5 * held) * share);
      gain[k] += (n[k] * lost - (u[k] - into * n[k]) * rubbed) * share * w;
    }
  }
  Body out = p;
  if (!(weight > 0) || p.v[3] <= 0) return out;
  for (int k = 0; k < 3; ++k) {
    const double pushed = push[k] / weight * (course ? course_share : 1);
    out.x[k] = float(p.x[k] + pushed);
    out.v[k] = float(p.v[k] + (course ? pushed * inverse_dt : gain[k] / weight));
  }
  return out;
}

class Separating : public testing::TestWithParam<Simd> {
 protected:
  void SetUp() override {
    if (!simd_available(GetParam())) GTEST_SKIP() << "not on this machine";
  }
  static Pairs within(const Crowd& crowd, float reach, Simd simd) {
    Pairs found;
    found.owner.resize(crowd.pairs.owner.size());
    found.neighbour.resize(crowd.pairs.owner.size());
    const int count = kernel_table(simd).pairs_within(
        {crowd.bodies.data(), crowd.count_pairs, crowd.pairs.owner.data(),
         crowd.pairs.neighbour.data(), reach, found.owner.data(), found.neighbour.data()});
    found.owner.resize(std::size_t(count));
    found.neighbour.resize(std::size_t(count));
    return found;
  }
  static std::vector<Body> separated(const Crowd& crowd, float& fastest, Simd simd) {
    std::vector<Body> out = crowd.bodies;
    Pairs room{crowd.pairs};
    std::vector<Asked> asked(crowd.pairs.owner.size());
    fastest =
        kernel_table(simd).separate({crowd.bodies.data(),
                                     0,
                                     crowd.owners,
                                     crowd.count_pairs,
                                     crowd.pairs.owner.data(),
                                     crowd.pairs.neighbour.data(),
                                     crowd.friction.data(),
                                     0.25f,
                                     100,
                                     out.data(),
                                     {room.owner.data(), room.neighbour.data(), asked.data()}});
    return out;
  }
};

TEST_P(Separating, FindsThePairsWithinADistance) {
  for (const int count : {1, 2, 5, 40, 67})
    for (const float reach : {0.5f, 1.0f, 2.5f}) {
      const Crowd crowd(count, count, false);
      const Pairs found = within(crowd, reach, GetParam());
      Pairs expected;
      for (int k = 0; k < crowd.count_pairs; ++k) {
        const int a = crowd.pairs.owner[std::size_t(k)], b = crowd.pairs.neighbour[std::size_t(k)];
        if (!crowd.near(a, b, reach)) continue;
        expected.owner.push_back(a);
        expected.neighbour.push_back(b);
      }
      EXPECT_EQ(found.owner, expected.owner);
      EXPECT_EQ(found.neighbour, expected.neighbour);
    }
}

TEST_P(Separating, MovesOwnersAsTheRulesSay) {
  for (const bool course : {false, true})
    for (const int count : {2, 9, 40, 67}) {
      const Crowd crowd(count, count - 1, course);
      float fastest = 0;
      const std::vector<Body> out = separated(crowd, fastest, GetParam());
      double greatest = 0;
      int moved = 0;
      for (int a = 0; a < count; ++a) {
        const Body& body = out[std::size_t(a)];
        const Body before = crowd.bodies[std::size_t(a)];
        const Body expected = a < crowd.owners ? plainly(crowd, a, 0.25, 100) : before;
        moved += body.x[0] != before.x[0];
        for (int k = 0; k < 4; ++k) {
          EXPECT_NEAR(body.x[k], expected.x[k], 1e-5) << count << " bodies, body " << a;
          EXPECT_NEAR(body.v[k], expected.v[k], 1e-4) << count << " bodies, body " << a;
        }
        for (int b = 0; b < count && a < crowd.owners; ++b) {
          double square = 0;
          for (int k = 0; k < 3; ++k)
            square += std::pow(double(before.v[k]) - crowd.bodies[std::size_t(b)].v[k], 2);
          if (b != a && crowd.near(a, b, 1)) greatest = std::max(greatest, square);
        }
      }
      EXPECT_NEAR(fastest, greatest, 1e-5);
      EXPECT_TRUE(count <= 9 || moved > count / 4) << moved;
    }
}

TEST_P(Separating, HasTheBitsOfTheScalarKernel) {
  for (const bool course : {false, true}) {
    const Crowd crowd(67, 50, course);
    float fastest = 0, fastest_scalar = 0;
    const std::vector<Body> out = separated(crowd, fastest, GetParam());
    const std::vector<Body> expected = separated(crowd, fastest_scalar, Simd::scalar);
    EXPECT_EQ(fastest, fastest_scalar);
    for (std::size_t a = 0; a < out.size(); ++a)
      for (int k = 0; k < 4; ++k) {
        EXPECT_EQ(out[a].x[k], expected[a].x[k]);
        EXPECT_EQ(out[a].v[k], expected[a].v[k]);
      }
  }
}

INSTANTIATE_TEST_SUITE_P(, Separating,
                         testing::Values(Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512),
                         [](const auto& test) { return std::string(simd_name(test.param)); });

}  // namespace
}  // namespace weft::physics
