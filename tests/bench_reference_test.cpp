// The double-precision reference and the elastica that benchmarks measure against, by closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../bench/elastica.h"
#include "../bench/held.h"
#include "../bench/verlet.h"

namespace bench {
namespace {

weft::Cloth patch(int n, double side) {
  weft::Cloth cloth;
  cloth.grid = {n, n, {0, 0, 0}, {side, 0, 0}, {0, 0, side}, 0};
  cloth.stiffness = {500, 250, 0};
  return cloth;
}

// A flat patch on a plane that is tilted by the angle φ: it sticks below atan μ, else slides with g (sin φ - μ cos φ).
TEST(BenchReference, SlidesOnAnInclineAsCoulombSays) {
  for (const double degrees : {10.0, 20.0, 30.0})
    for (const double mu : {0.0, 0.3, 0.5}) {
      const double phi = degrees * std::numbers::pi / 180, g = 9.81, seconds = 0.5;
      weft::Scene scene;
      scene.gravity = {g * std::sin(phi), -g * std::cos(phi), 0};  // as seen along the plane
      scene.cloths.push_back(patch(5, 0.2));
      weft::Collider plane;
      plane.shape = weft::Plane{{0, 0, 0}, {0, 1, 0}};
      plane.friction = {weft::FrictionModel::coulomb, mu, mu};
      scene.colliders.push_back(plane);
      Verlet verlet(scene);
      verlet.advance(seconds, 2000);
      const double a = std::max(0.0, g * (std::sin(phi) - mu * std::cos(phi)));
      const std::vector<double> x = verlet.positions();
      for (std::size_t p = 0; p < 25; ++p) {
        const double start = 0.2 * double(p % 5) / 4;
        EXPECT_NEAR(x[3 * p] - start, a * seconds * seconds / 2, 1e-3) << degrees << ' ' << mu;
        EXPECT_NEAR(x[3 * p + 1], 0, 1e-9);
      }
    }
}

// A pin that turns takes its particle along a circle; the cloth between two that turn alike turns with them.
TEST(BenchReference, PinsTurnByTheirKeys) {
  weft::Scene scene;
  scene.gravity = {0, 0, 0};
  scene.cloths.push_back(patch(5, 0.2));
  weft::Rotation turn{{0, 2, 0}, {0.1, 0, 0.1}, {{0, 0}, {0.5, 30}, {1, 90}}};
  for (int j = 0; j < 5; ++j)
    for (const int i : {0, 4}) scene.cloths[0].pins.push_back({i, j, {}, turn});
  const std::vector<Held> held = moving_pins(scene.cloths[0]);
  ASSERT_EQ(held.size(), 10u);
  const weft::Vec3 half = place_of(held[0], 0.5), end = place_of(held[0], 1);
  const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
  EXPECT_NEAR(half[0], 0.1 - 0.1 * c - 0.1 * s, 1e-12);
  EXPECT_NEAR(half[2], 0.1 + 0.1 * s - 0.1 * c, 1e-12);
  EXPECT_NEAR(end[0], 0, 1e-12);
  EXPECT_NEAR(end[2], 0.2, 1e-12);
  scene.cloths[0].drag = 20;
  Verlet verlet(scene);
  verlet.advance(1, 20000);
  const std::vector<double> x = verlet.positions();
  EXPECT_NEAR(x[0], end[0], 1e-12);
  EXPECT_NEAR(x[2], end[2], 1e-12);
  EXPECT_NEAR(x[3 * 12], 0.1, 1e-3);  // the middle
  EXPECT_NEAR(x[3 * 12 + 2], 0.1, 1e-3);
}

// A light strip sinks by q L⁴/(8 D); heavier ones as the table of validation says, inextensible.
TEST(BenchReference, ElasticaBendsAsItsTableSays) {
  const Strip light{0.5, 1e-3, 1, 1e9};
  EXPECT_NEAR(strip_at_rest(light, {0.5}).back().up, -1e-3 * std::pow(0.5, 4) / 8, 1e-11);
  struct Row {
    double gamma, drop, reach;
  };
  for (const Row& row :
       {Row{1, .1235, .9912}, {10, .7002, .6564}, {50, .9079, .2450}, {200, .9568, .1074}}) {
    const StripPoint end = strip_at_rest({1, row.gamma, 1, 1e9}, {-0.1, 0, 0.4, 1}).back();
    EXPECT_NEAR(-end.up, row.drop, 6e-5) << row.gamma;
    EXPECT_NEAR(end.along, row.reach, 6e-5) << row.gamma;
  }
}

// A strip of cloth of the reference at rest: small deflection q L⁴/(8 D), and the elastica's large one.
TEST(BenchReference, StripsHangAsTheElastica) {
  for (const double rigidity : {0.3, 8e-3}) {
    constexpr int n = 33;
    const double length = 0.3, h = length / (n - 1.5);
    weft::Scene scene;
    weft::Cloth cloth;
    cloth.grid = {n, 3, {-h / 2, 0, 0}, {h * (n - 1), 0, 0}, {0, 0, 2 * h}, 0};
    cloth.membrane = {100, 100, 0, 50, 0};
    cloth.bending = rigidity;
    cloth.drag = 4;
    for (int j = 0; j < 3; ++j)
      for (const int i : {0, 1}) cloth.pins.push_back({i, j, {}});
    scene.cloths.push_back(cloth);
    Verlet verlet(scene);
    verlet.come_to_rest(1e-3);
    const std::vector<double> x = verlet.positions();
    const StripPoint end = strip_at_rest({length, 0.3 * 9.81, rigidity, 100}, {length}).back();
    EXPECT_NEAR(x[3 * (n - 1)], end.along, 2e-3 * length);
    EXPECT_NEAR(x[3 * (n - 1) + 1], end.up, 2e-3 * std::abs(end.up));
    if (rigidity > 0.1) {
      EXPECT_NEAR(end.up, -0.3 * 9.81 * std::pow(length, 4) / 8 / rigidity, 1e-5);
    }
  }
}

}  // namespace
}  // namespace bench
