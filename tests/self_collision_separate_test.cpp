// Pushing pairs apart, kernel by kernel: against the same said plainly in double precision, for every
// instruction set, any numbers of pairs and both rules.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/kernels/contact.h"
#include "physics/model/random.h"

namespace weft::physics {
namespace {

constexpr int kPadding = 32;
constexpr float kDistance = 0.6f;

struct Body {
  float x[4], v[4];  // Place, Motion
};

struct Pairs {
  std::vector<std::int32_t> owner, neighbour;
};

// Bodies at random in a cube of side 2, some of them pinned, some at the same place, and all pairs.
struct Crowd {
  Crowd(int count, bool course, bool alike = false) {
    Random random(std::uint64_t(count), 0);
    const auto next = [&] { return float(random.symmetric()); };
    for (int a = 0; a < count; ++a) {
      bodies.push_back({{next(), next(), next(), kDistance * (1 + 0.2f * next())},
                        {next(), next(), next(), a % 7 == 3 ? 0 : 1 + 0.5f * next()}});
      friction.push_back(course       ? kCourseRule
                         : alike      ? 0.3f
                         : a % 3 == 0 ? 0
                                      : 0.5f * std::abs(next()));
    }
    if (count > 8) std::copy_n(bodies[2].x, 3, bodies[5].x);
    for (int a = 0; a < count; ++a)
      for (int b = a + 1; b < count; ++b) {
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

  std::vector<Place> places() const {
    std::vector<Place> places;
    for (const Body& b : bodies) places.push_back({{b.x[0], b.x[1], b.x[2], b.x[3]}});
    return places;
  }
  std::vector<Motion> motions() const {
    std::vector<Motion> motions;
    for (const Body& b : bodies) motions.push_back({{b.v[0], b.v[1], b.v[2], b.v[3]}});
    return motions;
  }

  int count_pairs;
  std::vector<Body> bodies;
  std::vector<float> friction;
  Pairs pairs;
};

// What the rules at the top of kernels/separate.cpp make of a body.
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
  // Those that touch and, where asked for, those that are close.
  static std::pair<Pairs, Pairs> found(const Crowd& crowd, float reach, bool close, Simd simd) {
    Pairs touching = crowd.pairs, near = crowd.pairs;
    const std::vector<Place> places = crowd.places();
    ClosePairs p{places.data(),
                 crowd.count_pairs,
                 crowd.pairs.owner.data(),
                 crowd.pairs.neighbour.data(),
                 reach,
                 {},
                 {touching.owner.data(), touching.neighbour.data()}};
    if (close) p.close = {near.owner.data(), near.neighbour.data()};
    const CloseFound count = kernel_table(simd).close_pairs(p);
    touching.owner.resize(std::size_t(count.touching + kPadding));  // kernels read beyond the last
    touching.neighbour.resize(touching.owner.size());
    near.owner.resize(std::size_t(count.close));
    near.neighbour.resize(near.owner.size());
    return {touching, near};
  }
  static std::vector<Body> separated(const Crowd& crowd, AskFound& done, bool alike, Simd simd) {
    std::vector<Place> place = crowd.places();
    std::vector<Motion> motion = crowd.motions();
    const BodyFriction friction{alike ? nullptr : crowd.friction.data(), crowd.friction[0]};
    const Pairs touching = found(crowd, 1, false, simd).first;
    const int count = int(touching.owner.size()) - kPadding;
    std::vector<Asked> asked(touching.owner.size());
    const KernelTable& kernels = kernel_table(simd);
    done = kernels.ask_pairs({place.data(), motion.data(), friction, count, touching.owner.data(),
                              touching.neighbour.data(), asked.data()});
    // In two parts, each of its own bodies.
    const auto bodies = std::int32_t(place.size());
    std::vector<AskedSum> sum(place.size());
    std::vector<std::int32_t> asked_of(2 * touching.owner.size());
    std::vector<std::uint8_t> moved(place.size() / 16 + 1);
    for (const auto& [begin, end] : {std::pair{0, bodies / 3}, {bodies / 3, bodies}}) {
      const int first = kernels.sum_asked({count, touching.owner.data(), touching.neighbour.data(),
                                           asked.data(), begin, end, sum.data(), asked_of.data()});
      kernels.move_bodies({place.data(), motion.data(), friction, sum.data(), first,
                           asked_of.data(), moved.data(), 0.25f, 100});
    }
    for (const AskedSum& s : sum)
      for (int k = 0; k < 4; ++k) EXPECT_TRUE(s.push[k] == 0 && s.gain[k] == 0);
    std::vector<Body> out = crowd.bodies;
    for (std::size_t a = 0; a < out.size(); ++a) {
      std::copy_n(place[a].x, 4, out[a].x);
      std::copy_n(motion[a].v, 4, out[a].v);
      const bool stayed = std::equal(out[a].x, out[a].x + 3, crowd.bodies[a].x);
      EXPECT_TRUE(stayed || moved[a / 16]) << "body " << a;
    }
    return out;
  }
};

TEST_P(Separating, FindsThePairsWithinADistance) {
  for (const int count : {1, 2, 5, 40, 67})
    for (const float reach : {0.5f, 1.0f, 2.5f}) {
      const Crowd crowd(count, false);
      const auto [touching, close] = found(crowd, reach, true, GetParam());
      const auto expected = [&](double within) {
        Pairs pairs;
        for (int k = 0; k < crowd.count_pairs; ++k) {
          const int a = crowd.pairs.owner[std::size_t(k)];
          const int b = crowd.pairs.neighbour[std::size_t(k)];
          if (!crowd.near(a, b, within)) continue;
          pairs.owner.push_back(a);
          pairs.neighbour.push_back(b);
        }
        return pairs;
      };
      EXPECT_EQ(close.owner, expected(reach).owner);
      EXPECT_EQ(close.neighbour, expected(reach).neighbour);
      const Pairs touch = expected(1);
      ASSERT_EQ(touching.owner.size(), touch.owner.size() + kPadding);
      EXPECT_TRUE(std::equal(touch.owner.begin(), touch.owner.end(), touching.owner.begin()));
      EXPECT_TRUE(
          std::equal(touch.neighbour.begin(), touch.neighbour.end(), touching.neighbour.begin()));
    }
}

TEST_P(Separating, MovesBodiesAsTheRulesSay) {
  for (const int rule : {0, 1, 2})
    for (const int count : {2, 9, 40, 67}) {
      const bool course = rule == 1, alike = rule == 2;
      const Crowd crowd(count, course, alike);
      AskFound done{};
      const std::vector<Body> out = separated(crowd, done, alike, GetParam());
      double fastest = 0, deepest = 0;
      int moved = 0;
      for (int a = 0; a < count; ++a) {
        const Body& body = out[std::size_t(a)];
        const Body before = crowd.bodies[std::size_t(a)];
        const Body expected = plainly(crowd, a, 0.25, 100);
        moved += body.x[0] != before.x[0];
        for (int k = 0; k < 4; ++k) {
          EXPECT_NEAR(body.x[k], expected.x[k], 1e-5) << count << " bodies, body " << a;
          EXPECT_NEAR(body.v[k], expected.v[k], 1e-4) << count << " bodies, body " << a;
        }
        for (int b = 0; b < count; ++b) {
          if (b == a || !crowd.near(a, b, 1)) continue;
          const Body& other = crowd.bodies[std::size_t(b)];
          double square = 0, apart = 0;
          for (int k = 0; k < 3; ++k) {
            square += std::pow(double(before.v[k]) - other.v[k], 2);
            apart += std::pow(double(before.x[k]) - other.x[k], 2);
          }
          fastest = std::max(fastest, square);
          deepest =
              std::max(deepest, 1 - std::sqrt(apart) / (0.5 * (double(before.x[3]) + other.x[3])));
        }
      }
      EXPECT_NEAR(done.fastest_squared, fastest, 1e-5);
      EXPECT_NEAR(done.deepest, deepest, 1e-6);
      EXPECT_TRUE(count <= 9 || moved > count / 4) << moved;
    }
}

TEST_P(Separating, HasTheBitsOfTheScalarKernel) {
  for (const bool course : {false, true}) {
    const Crowd crowd(67, course);
    AskFound done{}, done_scalar{};
    const std::vector<Body> out = separated(crowd, done, course, GetParam());
    const std::vector<Body> expected = separated(crowd, done_scalar, course, Simd::scalar);
    EXPECT_EQ(done.fastest_squared, done_scalar.fastest_squared);
    EXPECT_EQ(done.deepest, done_scalar.deepest);
    for (std::size_t a = 0; a < out.size(); ++a)
      for (int k = 0; k < 4; ++k) {
        EXPECT_EQ(out[a].x[k], expected[a].x[k]);
        EXPECT_EQ(out[a].v[k], expected[a].v[k]);
      }
  }
}

// Of a block in the middle of a lattice: bodies are the particles, and particles become the bodies.
TEST_P(Separating, BodiesAreTheParticles) {
  constexpr int kColumns = 21, kRows = 5, kStride = 48, kFirst = kStride + 16;
  constexpr std::size_t kFloats = std::size_t(kStride) * (kRows + 2);
  std::vector<float> lattice[7];
  Random random(1, 0);
  for (auto& component : lattice)
    for (std::size_t n = 0; n < kFloats; ++n) component.push_back(float(random.symmetric()));
  constexpr int kBodyStride = kStride + 5, kFirstBody = 7;
  std::vector<Place> place(kFirstBody + std::size_t(kBodyStride) * kRows);
  std::vector<Motion> motion(place.size());
  const auto at = [&](int c) { return lattice[c].data() + kFirst; };
  std::vector<float> load[3], ahead[3];
  for (int k = 0; k < 3; ++k) {
    load[k].resize(kFloats);
    ahead[k].resize(kFloats);
  }
  BodyBlock block{};
  block.columns = kColumns;
  block.rows = kRows;
  block.stride = kStride;
  block.x = {at(0), at(1), at(2)};
  block.v = {at(3), at(4), at(5)};
  block.w = at(6);
  block.held = 0.25f;
  block.body_stride = kBodyStride;
  block.place = place.data() + kFirstBody;
  block.motion = motion.data() + kFirstBody;
  block.load = {load[0].data() + kFirst, load[1].data() + kFirst, load[2].data() + kFirst};
  block.ahead = {ahead[0].data() + kFirst, ahead[1].data() + kFirst, ahead[2].data() + kFirst};
  block.since = 0.5f;
  block.inverse_since = 2;
  block.advance = 0.5f;
  std::vector<std::uint8_t> moved(place.size() / 16 + 2, 1), loaded(kFloats / 16);
  block.moved = moved.data();
  block.first_body = kFirstBody;
  block.loaded = loaded.data() + kFirst / 16;
  kernel_table(GetParam()).gather_bodies(block);
  // visit(number in the lattice, of the body)
  const auto each = [&](auto&& visit) {
    for (int j = 0; j < kRows; ++j)
      for (int i = 0; i < kColumns; ++i)
        visit(std::size_t(kFirst + j * kStride + i), std::size_t(kFirstBody + j * kBodyStride + i));
  };
  each([&](std::size_t n, std::size_t body) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(place[body].x[k], lattice[k][n]);
      EXPECT_EQ(motion[body].v[k], lattice[3 + k][n]);
      place[body].x[k] += 1;
      motion[body].v[k] -= 1;
    }
    EXPECT_EQ(place[body].x[3], 0.25f);
    EXPECT_EQ(motion[body].v[3], lattice[6][n]);
  });
  std::vector<float> expected[7];
  std::copy(std::begin(lattice), std::end(lattice), std::begin(expected));
  each([&](std::size_t n, std::size_t) {
    for (int k = 0; k < 3; ++k) {
      expected[k][n] += 1;
      expected[3 + k][n] -= 1;
    }
  });
  kernel_table(GetParam()).scatter_bodies(block);
  for (int c = 0; c < 7; ++c) EXPECT_EQ(lattice[c], expected[c]);
  // What has neither moved nor a load is passed over: the loads are gone after once more.
  std::fill(moved.begin(), moved.end(), std::uint8_t(0));
  for (const bool have_loads : {true, false}) {
    EXPECT_EQ(std::count(loaded.begin(), loaded.end(), 1), have_loads ? 2 * kRows : 0);
    for (Place& p : place) p.x[0] += 1;
    const std::vector<float> before = lattice[0];
    kernel_table(GetParam()).scatter_bodies(block);
    EXPECT_EQ(lattice[0] != before, have_loads);
  }
}

// A row of particles that contact gives the same velocity, time after time: half of it comes in advance
// from the second time on, and nothing where it comes from the other side or a particle is pinned.
TEST_P(Separating, LoadsThatLastAreCarriedInAdvance) {
  constexpr int kColumns = 20;
  constexpr std::size_t kFloats = 48;
  constexpr float kSince = 0.25f, kGain = 2;
  std::vector<float> x(kFloats, 1), v[3], w(kFloats, 1), load[3], ahead[3];
  for (int k = 0; k < 3; ++k)
    for (auto* component : {&v[k], &load[k], &ahead[k]}) component->resize(kFloats);
  w[3] = 0;
  std::vector<Place> place(kFloats);
  std::vector<Motion> motion(kFloats);
  BodyBlock block{};
  block.columns = kColumns;
  block.rows = 1;
  block.x = {x.data(), x.data(), x.data()};
  block.v = {v[0].data(), v[1].data(), v[2].data()};
  block.w = w.data();
  block.place = place.data();
  block.motion = motion.data();
  block.load = {load[0].data(), load[1].data(), load[2].data()};
  block.ahead = {ahead[0].data(), ahead[1].data(), ahead[2].data()};
  block.since = kSince;
  block.inverse_since = 1 / kSince;
  block.advance = 0.5f;
  const std::vector<std::uint8_t> moved(4, 1);
  std::vector<std::uint8_t> loaded(kFloats / 16);
  block.moved = moved.data();
  block.loaded = loaded.data();
  // What contact gives besides what it gave in advance, which has been used up by the next time.
  const auto press = [&](float gain) {
    for (auto& component : v) std::fill(component.begin(), component.end(), 0.0f);
    kernel_table(GetParam()).gather_bodies(block);
    for (std::size_t i = 0; i < kColumns; ++i) motion[i].v[1] += w[i] > 0 ? gain - ahead[1][i] : 0;
    kernel_table(GetParam()).scatter_bodies(block);
  };
  const auto given = [&](std::size_t i) { return std::vector<float>{v[1][i], ahead[1][i]}; };
  press(kGain);
  EXPECT_EQ(given(19), std::vector<float>({kGain, 0}));
  press(kGain);
  EXPECT_EQ(given(19), std::vector<float>({1.5f * kGain, 0.5f * kGain}));
  EXPECT_EQ(load[1][19], kGain / kSince);
  press(kGain);
  EXPECT_EQ(given(19), std::vector<float>({kGain, 0.5f * kGain}));
  press(0.75f * kGain);  // contact had to give a quarter
  EXPECT_EQ(ahead[1][19], 0.25f * kGain);
  press(0.25f * kGain);  // and now nothing
  EXPECT_EQ(ahead[1][19], 0);
  press(kGain);
  EXPECT_EQ(ahead[1][19], 0.125f * kGain);  // half of what both agree on
  press(-kGain);
  EXPECT_EQ(ahead[1][19], 0);
  EXPECT_EQ(given(3), std::vector<float>({0, 0}));
}

INSTANTIATE_TEST_SUITE_P(, Separating,
                         testing::Values(Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512),
                         [](const auto& test) { return std::string(simd_name(test.param)); });

}  // namespace
}  // namespace weft::physics
