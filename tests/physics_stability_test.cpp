// The stability limit: the estimate against a dense eigen-solver, and runs on either side of the
// true limit.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <string>

#include "physics/frame/cloth_step.h"
#include "physics/frame/projection_substep.h"
#include "physics/model/lattice/energy.h"
#include "physics/model/lattice/stability.h"
#include "physics/model/lattice/stages.h"
#include "physics/step/threads.h"
#include "weft/random.h"
#include "weft/simulation.h"

namespace weft::physics {
namespace {

struct Case {
  std::string name;
  int nx, ny, level;
  Kinds stiffness;
  double stretch, spread;  // of the whole sheet; of each particle, in spacings
  double gradient = 0, damping = 0;
  bool pinned = false, masses = false;
};

Scene scene_of(const Case& c) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {c.nx, c.ny, {0, 0, 0}, {0.1 * (c.nx - 1), 0, 0}, {0, 0, 0.1 * (c.ny - 1)}, 0};
  cloth.particle_mass = 0.01;
  cloth.stiffness = c.stiffness;
  cloth.level = c.level;
  cloth.stiffness_gradient = c.gradient;
  cloth.spring_damping = {c.damping, c.damping, 0};
  if (c.pinned) cloth.pins = {{0, 0, {}}, {c.nx - 1, 0, {}}};
  Random random(4, 4);
  for (int p = 0; c.masses && p < c.nx * c.ny; ++p)
    cloth.masses.push_back(0.005 + 0.02 * random.unit());
  return scene;
}

Lattice lattice_of(const Case& c, const Cloth& cloth) {
  Lattice l = make_lattice(cloth, 0, 1, false);
  Random random(8, 8);
  for (int j = 0; j < c.ny; ++j)
    for (int i = 0; i < c.nx; ++i)
      for (int k = 0; k < 3; ++k)
        l.x.at(k, j, i) = float(l.x.at(k, j, i) * c.stretch + 0.1 * c.spread * random.symmetric());
  return l;
}

// Largest eigenvalues of M^-½ K M^-½ and M^-½ D M^-½, assembled spring by spring.
Spectrum dense_spectrum(const Cloth& cloth, const Lattice& l) {
  const auto x = l.gather(l.x);
  const auto size = Eigen::Index(3 * x.size());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(size, size), damping = stiffness;
  const auto root_w = [&](int p) { return std::sqrt(double(l.w(p / l.columns, p % l.columns))); };
  for (const Stencil& f : stencils_of(cloth))
    for_each_constraint(cloth, f, [&](int a, int b, double k) {
      Eigen::Vector3d e;
      for (int c = 0; c < 3; ++c)
        e[c] = x[std::size_t(b)][std::size_t(c)] - x[std::size_t(a)][std::size_t(c)];
      const Eigen::Vector3d n = e.normalized();
      const Eigen::Matrix3d along = n * n.transpose();
      const double across = std::max(0.0, 1 - f.rest / e.norm());
      const Eigen::Matrix3d tangent = k * (along + across * (Eigen::Matrix3d::Identity() - along));
      const Eigen::Matrix3d loss = f.damping * (k / f.stiffness) * along;
      for (const auto& [p, q, sign] :
           {std::tuple{a, a, 1.0}, {b, b, 1.0}, {a, b, -1.0}, {b, a, -1.0}}) {
        const double scale = sign * root_w(p) * root_w(q);
        stiffness.block<3, 3>(3 * p, 3 * q) += scale * tangent;
        damping.block<3, 3>(3 * p, 3 * q) += scale * loss;
      }
    });
  const auto largest = [](const Eigen::MatrixXd& m) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m, Eigen::EigenvaluesOnly)
        .eigenvalues()
        .maxCoeff();
  };
  return {largest(stiffness), largest(damping)};
}

std::vector<Case> cases() {
  const Kinds plain{100, 80, 20};
  return {{"flat", 8, 8, 0, plain, 1, 0},
          {"stretched", 8, 8, 0, plain, 1.3, 0},
          {"compressed", 8, 8, 0, plain, 0.7, 0},
          {"crumpled", 8, 8, 0, plain, 1, 0.4},
          {"structural only", 8, 8, 0, {100, 0, 0}, 1, 0},
          {"structural, crumpled", 8, 8, 0, {100, 0, 0}, 1, 0.3},
          {"strip", 2, 40, 0, plain, 1.1, 0.05},
          {"row", 40, 2, 0, {100, 0, 0}, 1.2, 0},
          {"smallest", 2, 2, 0, plain, 1, 0.1},
          {"level 1", 8, 8, 1, plain, 1, 0},
          {"level 2", 8, 8, 2, plain, 1.2, 0.1},
          {"level 4", 9, 8, 4, plain, 1, 0.05},
          {"gradient", 6, 12, 0, plain, 1.1, 0.05, 0.8},
          {"pins", 8, 8, 0, plain, 1.1, 0.1, 0, 0, true},
          {"masses", 8, 8, 0, plain, 1, 0.1, 0, 0, true, true},
          {"damped", 8, 8, 0, plain, 1.1, 0.1, 0, 0.3, true, true}};
}

TEST(StabilityLimit, EstimateIsCloseAndNeverAbove) {
  for (const Case& c : cases()) {
    const Scene scene = scene_of(c);
    const Cloth& cloth = scene.cloths[0];
    const Lattice l = lattice_of(c, cloth);
    const bool damped = c.damping > 0;
    const Spectrum estimate =
        estimate_spectrum(cloth, stencils_of(cloth), l, damped, kernel_table(Simd::best));
    for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512}) {
      if (!simd_available(simd)) continue;
      const Spectrum same =
          estimate_spectrum(cloth, stencils_of(cloth), l, damped, kernel_table(simd));
      EXPECT_EQ(same.omega_squared, estimate.omega_squared) << c.name << ", " << simd_name(simd);
      EXPECT_EQ(same.damping, estimate.damping) << c.name << ", " << simd_name(simd);
    }
    Spectrum truth = dense_spectrum(cloth, l);
    if (!damped) truth.damping = 0;
    const double ratio = estimate.largest_substep() / truth.largest_substep();
    std::printf("%-22s limit %.5g s, estimate %.4f of it\n", c.name.c_str(),
                truth.largest_substep(), ratio);
    EXPECT_LE(ratio, 1) << c.name;
    EXPECT_GE(ratio, 0.9) << c.name;
  }
}

// Energy of the flat sheet after 4000 substeps of a share of the true limit over that of the start,
// straight through the plan, which does not mind unstable substeps. Small noise starts every mode.
double growth(const Case& c, double share, double drag = 0) {
  Scene scene = scene_of(c);
  scene.cloths[0].drag = drag;
  ClothStep step(scene, 0, Method::spring, 1, kernel_table(Simd::best));
  Lattice& l = step.model().lattice()->lattice;
  Spectrum truth = dense_spectrum(step.cloth(), l);
  truth.drag = drag;
  const double dt = share * truth.largest_substep();
  Random random(6, 6);
  for (int j = 0; j < l.rows; ++j)
    for (int i = 0; i < l.columns; ++i)
      for (int k = 0; k < 3; k += 2) l.x.at(k, j, i) += float(1e-4 * random.symmetric());
  const auto energy = [&] { return step.model().elastic_energy().sum(); };
  const double before = energy();
  Threads one(1);
  double most = 0;
  for (int n = 0; n < 40; ++n) {
    step.schedule().run({0, dt, 100, dt}, one);
    const double now = energy();
    if (!std::isfinite(now)) return std::numeric_limits<double>::infinity();
    most = std::max(most, now);
  }
  return most / before;
}

TEST(StabilityLimit, SeparatesBoundedFromExploding) {
  for (const Case& c : {Case{"plain", 8, 8, 0, {100, 80, 20}, 1, 0},
                        Case{"gradient", 10, 6, 0, {100, 80, 0}, 1, 0, 0.5, 0, true},
                        Case{"level", 8, 8, 2, {100, 0, 0}, 1, 0}}) {
    // Leapfrog keeps its own energy, which at dt ω = 2 · 0.98 is 1/(1 - 0.98²) = 25 times as large
    // as the true one at most; noise of all modes stays far below.
    EXPECT_LT(growth(c, 0.98), 50) << c.name;
    EXPECT_GT(growth(c, 1.05), 1e3) << c.name;
  }
}

// Drag is taken from velocities half a substep behind: the more there is of it, the shorter substeps have to be,
// until nothing is left of a velocity.
TEST(StabilityLimit, CountsDrag) {
  const Case c{"plain", 8, 8, 0, {100, 80, 20}, 1, 0};
  for (const double drag : {10.0, 50.0, 150.0, 400.0, 1e4}) {
    EXPECT_LT(growth(c, 0.98, drag), 50) << drag;
    EXPECT_GT(growth(c, 1.05, drag), 1e3) << drag;
  }
}

// Automatic substeps while a sheet is stretched, folded and swung: inside the true limit of the
// shape that the sheet has at every frame.
TEST(StabilityLimit, HoldsForTheShapeOfEveryFrame) {
  for (const Kinds& stiffness : {Kinds{100, 80, 20}, Kinds{100, 0, 0}}) {
    Case c{"falling", 9, 9, 0, stiffness, 1, 0};
    Scene scene = scene_of(c);
    scene.gravity = {0, -9.81, 0};
    scene.cloths[0].pins = {{0, 0, {}}};
    scene.cloths[0].drag = 1;
    scene.time = {1.0 / 60, kAutoSubsteps, 5};
    Simulation simulation(scene);
    Lattice l = make_lattice(scene.cloths[0], 0, 1, false);
    double worst = 0, energy = 0;
    for (int frame = 0; frame < 180; ++frame) {
      simulation.advance_frame();
      const auto x = simulation.positions();
      for (int p = 0; p < 81; ++p)
        for (int k = 0; k < 3; ++k) l.x.at(k, p / 9, p % 9) = float(x[std::size_t(3 * p + k)]);
      if (frame % 6 == 0)
        worst =
            std::max(worst, simulation.dt() / dense_spectrum(scene.cloths[0], l).largest_substep());
      energy = std::max(energy, simulation.report().energy.total);
    }
    std::printf("falling sheet, shear %g: substep at most %.3f of the true limit, energy %.3g J\n",
                stiffness.shear, worst, energy);
    EXPECT_LT(worst, 1);
    EXPECT_LT(energy, 0.01);  // it starts at rest at height 0
  }
}

// A sheet without shear springs folds onto a line without stretching anything, where its rows and
// columns pull the same way: twice the flat sheet's largest eigenvalue.
void fold(const Kinds& stiffness) {
  Scene scene = scene_of({"folded", 9, 9, 0, stiffness, 1, 0});
  scene.time = {1.0 / 60, kAutoSubsteps, 5};
  Simulation simulation(scene);
  std::vector<double> x;
  Random random(3, 3);
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 9; ++i)
      for (int k = 0; k < 3; ++k)
        x.push_back((k == 0 ? 0.1 * (i + j) : 0) + 1e-4 * random.symmetric());
  simulation.set_state(x, std::vector<double>(x.size(), 0.0));
  const double before = simulation.report().energy.total;
  Lattice l = make_lattice(scene.cloths[0], 0, 1, false);
  double worst = 0, most = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const auto y = simulation.positions();
    for (int p = 0; p < 81; ++p)
      for (int k = 0; k < 3; ++k) l.x.at(k, p / 9, p % 9) = float(y[std::size_t(3 * p + k)]);
    simulation.advance_frame();
    worst = std::max(worst, simulation.dt() / dense_spectrum(scene.cloths[0], l).largest_substep());
    most = std::max(most, simulation.report().energy.total);
  }
  std::printf("folded sheet, shear %g: substep at most %.3f of the true limit, energy %.3g-fold\n",
              stiffness.shear, worst, most / before);
  EXPECT_LT(worst, 1) << stiffness.shear;
  // The leapfrog's energy swings by 1/(1 - 0.9²) = 5 at 0.9 of the limit.
  EXPECT_LT(most, 5 * before) << stiffness.shear;
}

TEST(StabilityLimit, HoldsForASheetFoldedOntoALine) {
  for (const Kinds& stiffness : {Kinds{100, 0, 0}, Kinds{100, 80, 20}, Kinds{100, 100, 0},
                                 Kinds{0, 100, 0}, Kinds{20, 100, 0}})
    fold(stiffness);
}

// A sheet that hangs by its upper edge, at rest: automatic substeps of sweeps keep its strain to 2 %,
// and what the material gives, however many points it has and however large it is.
TEST(ProjectionSubstep, AHangingSheetStretchesByTwoPercent) {
  for (const Method method : {Method::positional, Method::compliant})
    for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::jacobi})
      for (const double size : {0.05, 1.0, 20.0})
        for (const int n : {12, 48}) {
          const double faster = std::sqrt(size);  // a small one moves faster
          Scene scene;
          Cloth cloth;
          cloth.grid = {6, n, {}, {5 * size / (n - 1), 0, 0}, {0, -size, 0}, 0};
          cloth.stiffness = {2000 * size, 2000 * size, 0};
          cloth.drag = 3 / faster;
          for (int i = 0; i < 6; ++i) cloth.pins.push_back({i, 0, {}});
          scene.cloths = {cloth};
          scene.solver.method = method;
          scene.solver.sweep = sweep;
          scene.time.frame = faster / 60;
          Simulation simulation(scene);
          for (int frame = 0; frame < 150; ++frame) simulation.advance_frame();
          const double given = 9.81 * 0.3 * size / 2000;
          EXPECT_LT(simulation.report(false).strain.max, 0.02 + given)
              << int(method) << " " << int(sweep) << " " << size << " m, " << n << " points, "
              << simulation.dt() << " s";
        }
}

TEST(ProjectionSubstep, IsNoShorterThanNeedBe) {
  Scene scene;
  scene.cloths.emplace_back();
  scene.solver.method = Method::compliant;
  EXPECT_EQ(projection_substep(scene), 1.0 / 960);  // coarse
  Grid& grid = scene.cloths[0].grid;
  grid.nx = grid.ny = 200;
  const double fine = projection_substep(scene);
  EXPECT_NEAR(fine, std::sqrt(0.02 / (2 * 9.81 * 200 * 199)), 1e-9);
  scene.solver.iterations = 4;
  EXPECT_NEAR(projection_substep(scene), 2 * fine, 1e-9);
  scene.solver.iterations = 1;
  scene.cloths[0].stiffness = {50, 50, 10};  // that one sweep can follow
  EXPECT_NEAR(projection_substep(scene), std::sqrt(0.3 / (199 * 199) / 50), 1e-9);
  scene.cloths[0].stiffness = {1000, 1000, 200};
  scene.solver.sweep = Sweep::line;
  EXPECT_EQ(projection_substep(scene), 1.0 / 960);
  scene.solver.sweep = Sweep::gauss_seidel;
  scene.gravity = {};
  EXPECT_EQ(projection_substep(scene), 1.0 / 960);
}

// Springs of a sheet that folds freely come to pull the same way, and so do their dampers.
TEST(StabilityLimit, HoldsForDampedSpringsOfASheetThatFolds) {
  for (const double sleep : {0.0, 0.005})
    for (const double size : {0.0025, 0.1})
      for (const double damping : {0.003, 0.03}) {
        Scene scene;
        scene.time.frame = 1.0 / 60;
        scene.solver.method = Method::spring_friction;
        scene.solver.sleep = sleep;
        Cloth& c = scene.cloths.emplace_back();
        c.grid = {5, 9, {0, 0, 0}, {size, 0, 0}, {0, 0, 10 * size}, 1e-3 * size};
        c.density = 0.3;
        c.stiffness = {0, 1e-42, 1100};
        c.spring_damping = {0, damping, 0};
        c.bending = 1.2e-5;
        c.spin = {0.2, 0.2, 0};
        Simulation simulation(scene);
        const auto start = simulation.report().energy;
        for (int n = 0; n < 4; ++n) simulation.advance_frame();
        const auto now = simulation.report().energy;
        EXPECT_LT(now.kinetic + now.elastic,
                  2 * (start.kinetic + start.elastic + start.gravity - now.gravity))
            << sleep << " " << size << " " << damping;
        EXPECT_FALSE(simulation.plan().fallback) << sleep << " " << size << " " << damping;
      }
}

}  // namespace
}  // namespace weft::physics
