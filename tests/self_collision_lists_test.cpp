// Surfaces measure the pairs of squares that are listed, and list only those anew that have moved far:
// they find the same as where all are listed every time.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "physics/contact/self/crossings.h"
#include "physics/contact/self/surface_contact.h"
#include "physics/model/lattice/lattice.h"
#include "physics/model/random.h"
#include "physics/step/threads.h"
#include "weft/scene.h"

namespace weft::physics {
namespace {

constexpr int kPoints = 14;
constexpr double kDt = 1e-3;
constexpr float kAbout = 0.03f;  // m, how far from their places particles fly

// Two sheets, the second above the first, and what keeps them apart.
struct Pair {
  Pair(const Scene& scene, float thickness, bool pinned) {
    for (int c = 0; c < 2; ++c) {
      sheet.push_back(make_lattice(scene.cloths[std::size_t(c)], c, 1, false));
      if (pinned) sheet.back().set_inverse_mass(0, 0, 0);
    }
    std::vector<Sheet> sheets;
    const float square = std::pow(1.0f / (kPoints - 1), 2.0f);
    for (Lattice& l : sheet) sheets.push_back({&l, thickness, 0.3f, square, 0, square, false});
    contact = SurfaceContact::make(scene, sheets, kernel_table(Simd::best));
  }
  void copy_state(const Pair& from) {
    for (std::size_t s = 0; s < 2; ++s) {
      sheet[s].x.copy(from.sheet[s].x);
      sheet[s].v.copy(from.sheet[s].v);
    }
  }
  // Moves everything for a substep: the upper sheet slides and waves over the lower; in the middle of
  // the time one half of it is torn away and comes back.
  void move(int step) {
    for (std::size_t s = 0; s < 2; ++s)
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i) {
          if (sheet[s].w(j, i) <= 0) continue;
          const float wave = std::sin(0.9f * float(i) + 0.6f * float(j) + 0.05f * float(step));
          float speed[3] = {1.5f * float(s), 0.8f * wave * float(s), 0.4f * wave};
          if (s == 1 && i >= kPoints / 2 && step >= 60 && step < 120)
            speed[1] += step < 90 ? 6 : -6;
          for (int k = 0; k < 3; ++k) {
            sheet[s].v.at(k, j, i) = speed[k];
            sheet[s].x.at(k, j, i) += speed[k] * float(kDt);
          }
        }
  }

  std::vector<Lattice> sheet;
  std::unique_ptr<SurfaceContact> contact;
};

Eigen::Vector3d at(const Lattice& sheet, int row, int column) {
  return {sheet.x.at(0, row, column), sheet.x.at(1, row, column), sheet.x.at(2, row, column)};
}

class SurfaceLists : public testing::TestWithParam<bool> {};

Scene two_sheets() {
  Scene scene;
  scene.cloths.resize(2);
  for (std::size_t c = 0; c < 2; ++c) {
    scene.cloths[c].grid.nx = scene.cloths[c].grid.ny = kPoints;
    scene.cloths[c].grid.origin = {0.2 * double(c), 0.06 * double(c), 0.1 * double(c)};
    scene.cloths[c].self_collision.mode = SelfCollisionMode::surface;
  }
  return scene;
}

TEST_P(SurfaceLists, FindWhatIsFoundWhereAllAreListed) {
  const Scene scene = two_sheets();
  Pair pair(scene, 0.05f, GetParam()), fresh(scene, 0.05f, GetParam());
  Threads threads(2);
  pair.contact->begin(threads);
  int pushes = 0;
  for (int step = 0; step < 240; ++step) {
    pair.move(step);
    fresh.copy_state(pair);
    fresh.contact->begin(threads);
    Pair before(scene, 0.05f, GetParam());
    before.copy_state(pair);
    pair.contact->run(kDt, 8, threads);
    for (std::size_t s = 0; s < 2; ++s)
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i)
          for (int k = 0; k < 3; ++k) {
            const float x = pair.sheet[s].x.at(k, j, i);
            ASSERT_NEAR(x, fresh.sheet[s].x.at(k, j, i), 1e-6)
                << step << ": " << s << ' ' << j << ' ' << i;
            pushes += std::abs(x - before.sheet[s].x.at(k, j, i)) > 1e-6f;
          }
  }
  EXPECT_GT(pushes, 1000);
  EXPECT_EQ(pair.contact->held_back(), 0);
  EXPECT_EQ(pair.contact->measured(), 241);
  EXPECT_GT(pair.contact->listed(), 0);
  EXPECT_LT(pair.contact->listed(), 0.8 * 241) << "squares listed, in times all of them";
}

// Particles of both sheets fly about at random, up to a quarter of a spacing a substep, and through each
// other but for what holds them back; most of the time only those near their bounds are measured.
TEST_P(SurfaceLists, NothingPassesWhateverMoves) {
  const Scene scene = two_sheets();
  Pair pair(scene, 0.003f, GetParam());
  Threads threads(1);
  pair.contact->begin(threads);
  std::vector<Face> faces;
  for (int s = 0; s < 2; ++s) add_faces(kPoints, kPoints, s * kPoints * kPoints, faces);
  Random random(7, 1);
  int wait = 1, since = 0;
  for (int step = 0; step < 1200; ++step) {
    const bool wild = step / 150 % 2 == 1;  // else few fly, and the upper sheet sinks or rises
    for (std::size_t s = 0; s < 2; ++s)
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i) {
          if (pair.sheet[s].w(j, i) <= 0) continue;
          const bool flies = wild || random.symmetric() > 0.97;
          for (int k = 0; k < 3; ++k) {
            // About where it lies in its sheet, which stretches none so much that it counts as torn; and
            // both about one height, so that they are in each other's way.
            const float home[3] = {float(i) / (kPoints - 1) + 0.2f * float(s), 0,
                                   float(j) / (kPoints - 1) + 0.1f * float(s)};
            const float x = pair.sheet[s].x.at(k, j, i);
            const float sinks = k == 1 && s == 1 ? (step / 300 % 2 == 0 ? -5e-4f : 5e-4f) : 0;
            const float to = x + (flies ? 0.02f * float(random.symmetric()) : sinks);
            const float at = std::clamp(to, home[k] - kAbout, home[k] + kAbout);
            pair.sheet[s].v.at(k, j, i) = (at - x) / float(kDt);
            pair.sheet[s].x.at(k, j, i) = at;
          }
        }
    if (++since < wait) continue;
    wait = pair.contact->run(kDt, since, threads);
    since = 0;
    std::vector<Vec3> x;
    for (std::size_t s = 0; s < 2; ++s)
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i) {
          Vec3 p;
          for (int k = 0; k < 3; ++k) p[std::size_t(k)] = pair.sheet[s].x.at(k, j, i);
          x.push_back(p);
        }
    ASSERT_EQ(count_crossings(x, faces), 0) << step;
  }
  EXPECT_GT(pair.contact->held_back(), 10000);
  EXPECT_GT(pair.contact->measured(), 100);
  EXPECT_GT(pair.contact->measured_in_part(), 100);
}

// A corner turned over the diagonal of its square comes to lie on the other half of it, and is not
// pressed through.
TEST(SurfaceSquare, DoesNotFoldThroughItself) {
  Scene scene;
  scene.cloths.resize(1);
  scene.cloths[0].grid.nx = scene.cloths[0].grid.ny = 3;
  scene.cloths[0].self_collision.mode = SelfCollisionMode::surface;
  Lattice sheet = make_lattice(scene.cloths[0], 0, 1, false);
  const auto contact = SurfaceContact::make(scene, {{&sheet, 0.02f, 0.3f, 0.25f, 0, 0.25f, false}},
                                            kernel_table(Simd::best));
  Threads threads(1);
  contact->begin(threads);
  // Square A(0, 0), B(0.5, 0), C(0, 0.5), D(0.5, 0.5) in x and z, as it was made; y is up.
  double highest = 0;
  for (int degrees = 0; degrees <= 200; ++degrees) {
    const double angle = degrees * 3.14159265358979 / 180, far = 0.25 - 0.08 * degrees / 200;
    const double to[3] = {0.25 - far * std::cos(angle), far * std::sin(angle),
                          0.25 - far * std::cos(angle)};
    for (int k = 0; k < 3; ++k) {
      const double step = to[k] - sheet.x.at(k, 0, 0);
      sheet.x.at(k, 0, 0) += float(step);
      sheet.v.at(k, 0, 0) = float(step / kDt);
    }
    contact->run(kDt, 1, threads);
    const Eigen::Vector3d b = at(sheet, 0, 1), c = at(sheet, 1, 0), d = at(sheet, 1, 1);
    const double height = (c - b).cross(d - b).normalized().dot(at(sheet, 0, 0) - b);
    highest = std::max(highest, height);
    if (degrees > 10) {
      EXPECT_GT(height, 0) << degrees;
    }
  }
  EXPECT_GT(highest, 0.1);
}

INSTANTIATE_TEST_SUITE_P(, SurfaceLists, testing::Bool(),
                         [](const auto& test) { return test.param ? "Pinned" : "Free"; });

}  // namespace
}  // namespace weft::physics
