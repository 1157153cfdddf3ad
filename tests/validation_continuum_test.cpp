// The sheet behind the lattice: how the distance from one resolution to the next falls.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "truth.h"
#include "weft/simulation.h"

namespace weft {
namespace {

// A sheet of 1 m that is held along its whole side i = 0 and falls for half a second.
Scene curtain(int n) {
  Scene scene;
  scene.gravity = {2, -9, 3};
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.grid = {n, n, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.density = 0.3;
  cloth.stiffness = {1000, 500, 0};
  cloth.bending = 1e-3;
  cloth.drag = 1;
  for (int j = 0; j < n; ++j) cloth.pins.push_back({0, j, {}});
  return scene;
}

std::vector<double> after_half_a_second(const Scene& scene) {
  Simulation simulation(scene);
  for (int frame = 0; frame < 30; ++frame) simulation.advance_frame();
  EXPECT_TRUE(simulation.status().ok);
  return simulation.positions();
}

// RMS distance of a sheet of n x n points from one of (2 n - 1) x (2 n - 1) at the points of both [m].
double distance(const std::vector<double>& coarse, const std::vector<double>& fine, std::size_t n) {
  double sum = 0;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double e = coarse[3 * (j * n + i) + k] - fine[3 * (2 * j * (2 * n - 1) + 2 * i) + k];
        sum += e * e;
      }
  return std::sqrt(sum / double(n * n));
}

// From 17 to 33 points a side, and on to 65; or from another number of squares a side.
double order_in_space(const std::function<void(Scene&)>& change, int coarsest = 16) {
  std::vector<double> before;
  double distances[2] = {};
  for (int step = 0; step < 3; ++step) {
    Scene scene = curtain((coarsest << step) + 1);
    change(scene);
    const std::vector<double> now = after_half_a_second(scene);
    if (step > 0)
      distances[step - 1] = distance(before, now, std::size_t(((coarsest / 2) << step) + 1));
    before = now;
  }
  return std::log2(distances[0] / distances[1]);
}

constexpr const char* kLaw = "curtain, order in space";

void expect_order(const std::string& name, double least, double order) {
  expect_above({kLaw, name, least, 0, "log₂"}, order);
}

void lines(Scene& scene, int order) {
  scene.solver.method = Method::compliant;
  scene.solver.sweep = Sweep::line;
  scene.solver.order = order;
  scene.time.substeps = 100 * order;
}

TEST(Curtain, IsOfSecondOrderInSpaceWhereItsBorderCountsHalf) {
  const std::string points = ", 17, 33 and 65 points a side";
  expect_order("springs" + points, 1.9, order_in_space([](Scene&) {}));
  expect_order("lines, order 2" + points, 1.9, order_in_space([](Scene& s) { lines(s, 2); }));
}

// A fabric that is stiff along its threads and soft in shear (C11 = 3000, C22 = 2000, C12 = 200,
// C66 = 80 N/m, D = 2e-4 N·m), and one that agrees with the springs above.
TEST(Curtain, IsOfSecondOrderInSpaceAsAMembrane) {
  const auto as = [](const Membrane& membrane, double bending) {
    return [=](Scene& s) {
      s.cloths[0].stiffness = Kinds{1000, 1000, 200};  // none given
      s.cloths[0].membrane = membrane;
      s.cloths[0].bending = bending;
    };
  };
  expect_order("membrane, 17, 33 and 65 points a side", 1.9,
               order_in_space(as({1500, 1500, 500, 500, 0}, 1e-3)));
  expect_order("woven membrane, 33, 65 and 129 points a side", 1.7,
               order_in_space(as({3000, 2000, 200, 80, 0}, 2e-4), 32));
}

// Springs and the membrane agree to first order in strain.
TEST(Curtain, OfSpringsAndOfTheMembraneThatTheyStandForAgree) {
  Scene springs = curtain(65), membrane = springs;
  membrane.cloths[0].stiffness = Kinds{1000, 1000, 200};
  membrane.cloths[0].membrane = {1500, 1500, 500, 500, 0};
  const std::vector<double> a = after_half_a_second(springs), b = after_half_a_second(membrane);
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  expect({"curtain, springs against the membrane that they stand for", "65 points a side", 0, 2e-4,
          "m"},
         std::sqrt(3 * sum / double(a.size())));
}

TEST(Curtain, IsOfFirstOrderWhereAllCountsAlike) {
  expect({kLaw, "springs, all alike, 17, 33 and 65 points a side", 1, 0.2, "log₂"},
         order_in_space([](Scene& s) { s.cloths[0].lumping = Lumping::equal; }));
}

TEST(Lumping, SharesTheMassByArea) {
  for (const auto& [nx, ny] : {std::pair{2, 2}, {2, 7}, {5, 4}}) {
    Cloth cloth;
    cloth.grid = {nx, ny, {0, 0, 0}, {1.2, 0, 0}, {0, 0.3, 0.5}, 0};
    const double area = 1.2 * std::hypot(0.3, 0.5);
    double sum = 0;
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const bool side = i == 0 || i == nx - 1, end = j == 0 || j == ny - 1;
        const double one = 0.3 * area / ((nx - 1) * (ny - 1)) * (side ? 0.5 : 1) * (end ? 0.5 : 1);
        EXPECT_NEAR(particle_mass(cloth, i, j), one, 1e-15);
        sum += particle_mass(cloth, i, j);
      }
    EXPECT_NEAR(sum, 0.3 * area, 1e-13);
    cloth.lumping = Lumping::equal;
    EXPECT_NEAR(particle_mass(cloth, 0, 0), 0.3 * area / (nx * ny), 1e-15);
    cloth.lumping = Lumping::area;
    cloth.particle_mass = 0.4;
    EXPECT_EQ(particle_mass(cloth, 0, 0), 0.4);
  }
}

TEST(Lumping, HalvesWhatLiesAlongTheBorder) {
  Cloth cloth;
  cloth.grid = {6, 5, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  EXPECT_EQ(width_share(cloth, 2, 0, 1, 0), 0.5);
  EXPECT_EQ(width_share(cloth, 2, 4, 2, 0), 0.5);
  EXPECT_EQ(width_share(cloth, 2, 1, 1, 0), 1);
  EXPECT_EQ(width_share(cloth, 0, 1, 0, 1), 0.5);
  EXPECT_EQ(width_share(cloth, 5, 1, 0, 2), 0.5);
  EXPECT_EQ(width_share(cloth, 0, 0, 1, 1), 1);
  cloth.particle_mass = 0.1;  // the lattice itself is meant
  EXPECT_EQ(width_share(cloth, 2, 0, 1, 0), 1);
  cloth.lumping = Lumping::area;
  EXPECT_EQ(width_share(cloth, 2, 0, 1, 0), 0.5);
}

// A sheet of one strip pulled by its weight stretches like one of many: its width stands for the same cloth.
TEST(Lumping, StretchesAlikeWhateverTheNumberOfColumns) {
  for (const Method method : {Method::spring, Method::compliant}) {
    std::vector<double> drops;
    for (const int nx : {2, 3, 9, 40}) {
      Scene scene;
      scene.solver.method = method;
      if (method == Method::compliant) scene.solver.sweep = Sweep::line;
      scene.time = {0.01, method == Method::spring ? kAutoSubsteps : 10, 1};
      Cloth& cloth = scene.cloths.emplace_back();
      cloth.grid = {nx, 11, {0, 0, 0}, {0.4, 0, 0}, {0, -1, 0}, 0};
      // Of a strip h wide, k is the stiffness for each width h.
      cloth.stiffness = {50, 0, 0};
      cloth.density = 0.3 * (nx - 1) / 8;
      cloth.drag = 6;
      for (int i = 0; i < nx; ++i) cloth.pins.push_back({i, 0, {}});
      Simulation simulation(scene);
      for (int frame = 0; frame < 400; ++frame) simulation.advance_frame();
      const std::vector<double> x = simulation.positions();
      for (const int i : {0, nx / 2, nx - 1})
        drops.push_back(-x[3 * std::size_t(10 * nx + i) + 1] - 1);
    }
    for (const double drop : drops) EXPECT_NEAR(drop, drops[0], 2e-4 * drops[0]);
  }
}

}  // namespace
}  // namespace weft
