// Surfaces measure the pairs of squares that are listed, and list them anew once blocks have moved far against each
// other: they find the same as where all are listed every time.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "physics/contact/self/crossings.h"
#include "physics/contact/self/self_contact.h"
#include "physics/frame/cloth_step.h"
#include "physics/model/lattice/stages.h"
#include "physics/step/threads.h"
#include "squares.h"
#include "weft/random.h"
#include "weft/scene.h"

namespace weft::physics {
namespace {

constexpr int kPoints = 14;
constexpr double kDt = 1e-3;
constexpr float kAbout = 0.03f;  // m, how far from their places particles fly

// Two sheets, the second above the first, and what keeps them apart.
struct Pair {
  Pair(const Scene& scene, bool pinned) {
    for (int c = 0; c < 2; ++c) {
      steps.push_back(
          std::make_unique<ClothStep>(scene, c, Method::spring, 1, kernel_table(Simd::best)));
      if (pinned) sheet(std::size_t(c)).set_inverse_mass(0, 0, 0);
    }
    contact = SelfContact::make(scene, models_of(steps), kernel_table(Simd::best));
  }
  Lattice& sheet(std::size_t s) { return steps[s]->model().lattice()->lattice; }
  void copy_state(Pair& from) {
    for (std::size_t s = 0; s < 2; ++s) {
      sheet(s).x.copy(from.sheet(s).x);
      sheet(s).v.copy(from.sheet(s).v);
    }
  }
  // Moves everything for a substep: the upper sheet slides and waves over the lower; in the middle of
  // the time one half of it is torn away and comes back. `faster`: than that.
  void move(int step, float faster = 1) {
    for (std::size_t s = 0; s < 2; ++s)
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i) {
          if (sheet(s).w(j, i) <= 0) continue;
          const float wave = std::sin(0.9f * float(i) + 0.6f * float(j) + 0.05f * float(step));
          float speed[3] = {1.5f * float(s), 0.8f * wave * float(s), 0.4f * wave};
          if (s == 1 && i >= kPoints / 2 && step >= 60 && step < 120)
            speed[1] += step < 90 ? 6 : -6;
          for (int k = 0; k < 3; ++k) {
            sheet(s).v.at(k, j, i) = faster * speed[k];
            sheet(s).x.at(k, j, i) += faster * speed[k] * float(kDt);
          }
        }
  }

  std::vector<std::unique_ptr<ClothStep>> steps;
  std::unique_ptr<SelfContact> contact;
};

Eigen::Vector3d at(const Lattice& sheet, int row, int column) {
  return {sheet.x.at(0, row, column), sheet.x.at(1, row, column), sheet.x.at(2, row, column)};
}

class SurfaceLists : public testing::TestWithParam<bool> {};

Scene two_sheets(double thickness) {
  Scene scene;
  scene.cloths.resize(2);
  for (std::size_t c = 0; c < 2; ++c) {
    scene.cloths[c].grid.nx = scene.cloths[c].grid.ny = kPoints;
    scene.cloths[c].grid.origin = {0.2 * double(c), 0.06 * double(c), 0.1 * double(c)};
    scene.cloths[c].self_collision.mode = SelfCollisionMode::surface;
    scene.cloths[c].self_collision.thickness = thickness;
  }
  return scene;
}

// Each time from the same state; what was found before must not tell.
TEST_P(SurfaceLists, FindWhatIsFoundWhereAllAreListed) {
  const Scene scene = two_sheets(0.05);
  Pair pair(scene, GetParam());
  Threads threads(2);
  pair.contact->begin(threads);
  int changes = 0;
  for (int step = 0; step < 240; ++step) {
    Pair fresh(scene, GetParam());
    fresh.copy_state(pair);
    fresh.contact->begin(threads);
    pair.move(step);
    fresh.copy_state(pair);
    Pair before(scene, GetParam());
    before.copy_state(pair);
    pair.contact->run({kDt, 1, 0}, threads);
    fresh.contact->run({kDt, 1, 0}, threads);
    for (std::size_t s = 0; s < 2; ++s)
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i)
          for (int k = 0; k < 3; ++k) {
            const float x = pair.sheet(s).x.at(k, j, i);
            // Impulses begin otherwise, and end nearly alike.
            ASSERT_NEAR(x, fresh.sheet(s).x.at(k, j, i), 2e-4)
                << step << ": " << s << ' ' << j << ' ' << i;
            changes += std::abs(x - before.sheet(s).x.at(k, j, i)) > 1e-6f;
          }
  }
  EXPECT_GT(changes, 1000);
  EXPECT_GT(pair.contact->record().searches, 1);
  EXPECT_LT(pair.contact->record().searches, 0.8 * 240);
}

// Particles of both sheets fly about at random, up to a quarter of a spacing a substep, and through each
// other but for contact.
TEST_P(SurfaceLists, NothingPassesWhateverMoves) {
  const Scene scene = two_sheets(0.003);
  Pair pair(scene, GetParam());
  Threads threads(1);
  pair.contact->begin(threads);
  std::vector<Face> faces;
  for (int s = 0; s < 2; ++s) add_squares(kPoints, kPoints, s * kPoints * kPoints, faces);
  Random random(7, 1);
  for (int step = 0; step < 1200; ++step) {
    const bool wild = step / 150 % 2 == 1;  // else few fly, and the upper sheet sinks or rises
    for (std::size_t s = 0; s < 2; ++s)
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i) {
          if (pair.sheet(s).w(j, i) <= 0) continue;
          const bool flies = wild || random.symmetric() > 0.97;
          for (int k = 0; k < 3; ++k) {
            // About where it lies in its sheet, which stretches none so much that it counts as torn; and
            // both about one height, so that they are in each other's way.
            const float home[3] = {float(i) / (kPoints - 1) + 0.2f * float(s), 0,
                                   float(j) / (kPoints - 1) + 0.1f * float(s)};
            const float x = pair.sheet(s).x.at(k, j, i);
            const float sinks = k == 1 && s == 1 ? (step / 300 % 2 == 0 ? -5e-4f : 5e-4f) : 0;
            const float to = x + (flies ? 0.02f * float(random.symmetric()) : sinks);
            const float at = std::clamp(to, home[k] - kAbout, home[k] + kAbout);
            pair.sheet(s).v.at(k, j, i) = (at - x) / float(kDt);
            pair.sheet(s).x.at(k, j, i) = at;
          }
        }
    pair.contact->run({kDt, 1, 0}, threads);
    std::vector<Vec3> x;
    for (std::size_t s = 0; s < 2; ++s)
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i) {
          Vec3 p;
          for (int k = 0; k < 3; ++k) p[std::size_t(k)] = pair.sheet(s).x.at(k, j, i);
          x.push_back(p);
        }
    ASSERT_EQ(count_crossings(x, faces), 0) << step;
  }
  EXPECT_GT(pair.contact->record().contacts, 10000);
}

// Moves particles about their places at random, now wildly, now a few, now hardly.
void shake(Pair& pair, int step, Random& random) {
  const float most[] = {0.02f, 0.002f, 1e-5f};
  const float by = most[step / 20 % 3];
  for (std::size_t s = 0; s < 2; ++s)
    for (int j = 0; j < kPoints; ++j)
      for (int i = 0; i < kPoints; ++i)
        for (int k = 0; k < 3; ++k) {
          const float off = by * float(random.symmetric());
          if (pair.sheet(s).w(j, i) <= 0) continue;
          const float home[3] = {float(i) / (kPoints - 1) + 0.2f * float(s), 0.02f * float(s),
                                 float(j) / (kPoints - 1) + 0.1f * float(s)};
          const float x = pair.sheet(s).x.at(k, j, i);
          const float to = std::clamp(x + off, home[k] - kAbout, home[k] + kAbout);
          pair.sheet(s).v.at(k, j, i) = (to - x) / float(kDt);
          pair.sheet(s).x.at(k, j, i) = to;
        }
}

// Pairs that sleep would change nothing: the same bits where none sleeps, since every interval begins anew.
TEST_P(SurfaceLists, WhatSleepsHasNothingToTouch) {
  for (const double thickness : {0.003, 0.02, 0.08})
    for (const float faster : {0.0f, 0.02f, 1.0f, 4.0f})  // 0: shaken
      for (const int count : {1, 2}) {
        const Scene scene = two_sheets(thickness);
        Pair sleeps(scene, GetParam()), awake(scene, GetParam());
        Threads threads(count);
        Random random(5, 1), same(5, 1);
        std::int64_t contacts = 0;
        sleeps.contact->begin(threads);
        for (int step = 0; step < 80; ++step) {
          awake.contact->begin(threads);
          if (faster > 0) {
            sleeps.move(step, faster);
            awake.move(step, faster);
          } else {
            shake(sleeps, step, random);
            shake(awake, step, same);
          }
          sleeps.contact->run({kDt, 1, 0}, threads);
          awake.contact->run({kDt, 1, 0}, threads);
          ASSERT_EQ(sleeps.contact->record().contacts, awake.contact->record().contacts)
              << thickness << ' ' << faster << ' ' << step;
          contacts = sleeps.contact->record().contacts;
          for (std::size_t s = 0; s < 2; ++s)
            for (int j = 0; j < kPoints; ++j)
              for (int i = 0; i < kPoints; ++i)
                for (int k = 0; k < 3; ++k)
                  ASSERT_EQ(sleeps.sheet(s).x.at(k, j, i), awake.sheet(s).x.at(k, j, i))
                      << thickness << ' ' << faster << ' ' << step << ": " << s << ' ' << j << ' '
                      << i;
        }
        if (faster == 0.0f || thickness > 0.05) {
          EXPECT_GT(contacts, 100) << thickness << ' ' << faster;
        }
      }
}

// A corner turned over the diagonal of its square comes to lie on the other half of it, and is not
// pressed through.
TEST(SurfaceSquare, DoesNotFoldThroughItself) {
  Scene scene;
  scene.cloths.resize(1);
  scene.cloths[0].grid.nx = scene.cloths[0].grid.ny = 3;
  scene.cloths[0].self_collision.mode = SelfCollisionMode::surface;
  scene.cloths[0].self_collision.thickness = 0.02;
  std::vector<std::unique_ptr<ClothStep>> steps;
  steps.push_back(
      std::make_unique<ClothStep>(scene, 0, Method::spring, 1, kernel_table(Simd::best)));
  Lattice& sheet = steps[0]->model().lattice()->lattice;
  const auto contact = SelfContact::make(scene, models_of(steps), kernel_table(Simd::best));
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
    contact->run({kDt, 1, 0}, threads);
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
