// The second-order substep, tethers, and whole runs of line sweeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "oracle.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

Scene hanging(int n, double k, int substeps) {
  Scene s;
  s.solver.method = Method::compliant;
  s.solver.sweep = Sweep::line;
  s.time.substeps = substeps;
  Cloth c;
  c.grid.nx = c.grid.ny = n;
  c.stiffness = {k, k, 0.2 * k};
  c.pins = {{0, 0, {}}, {n - 1, 0, {}}};
  s.cloths.push_back(c);
  return s;
}

std::vector<double> run(const Scene& scene, int frames, Options options = {}) {
  Simulation simulation(scene, options);
  for (int f = 0; f < frames; ++f) simulation.advance_frame();
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  return simulation.positions();
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(3 * sum / double(a.size()));
}

// The scene by springs in double precision after so many frames, at the limit of ever finer substeps: drag
// makes the error of the leapfrog one of first order.
std::vector<double> spring_limit(Scene scene, int frames) {
  scene.solver = {};
  const std::vector<double> start = Simulation(scene).positions();
  const auto positions = [&](int substeps) {
    scene.time.substeps = substeps;
    oracle::Cloth cloth(scene, start);
    cloth.set_velocities(std::vector<double>(start.size()));
    for (int n = 0; n < frames * substeps; ++n) cloth.substep();
    std::vector<double> x;
    for (const oracle::Particle& p : cloth.particles) x.insert(x.end(), p.x.begin(), p.x.end());
    return x;
  };
  const std::vector<double> coarse = positions(200);
  std::vector<double> x = positions(400);
  for (std::size_t n = 0; n < x.size(); ++n) x[n] += x[n] - coarse[n];
  return x;
}

TEST(SecondOrder, ErrorFallsWithTheSquareOfTheSubstep) {
  // Springs as forces far below their stability limit converge to the same motion.
  for (const Lumping lumping : {Lumping::equal, Lumping::area})
    for (const double drag : {0.0, 2.0}) {
      const auto sheet = [&](int substeps) {
        Scene s = hanging(6, 50, substeps);
        s.solver.order = 2;
        s.solver.iterations = 6;
        s.cloths[0].lumping = lumping;
        s.cloths[0].drag = drag;
        return s;
      };
      const std::vector<double> truth = spring_limit(sheet(200), 12);
      std::vector<double> error;
      for (const int substeps : {2, 4, 8}) error.push_back(rms(run(sheet(substeps), 12), truth));
      const double slope = std::log2(error.front() / error.back()) / 2;
      std::printf("lumping %d, drag %g: errors %.2e %.2e %.2e m, slope %.2f\n", int(lumping), drag,
                  error[0], error[1], error[2], slope);
      // By area the errors are smaller, and rounding of positions is most of the last one.
      EXPECT_GT(slope, lumping == Lumping::equal ? 1.8 : 1.7);
      EXPECT_LT(error.front(), 5e-4);
      EXPECT_LT(error.back(), 4e-5);
    }
}

TEST(SecondOrder, FallsFreelyWithoutError) {
  Scene s = hanging(8, 1000, 5);
  s.cloths[0].pins.clear();
  s.solver.order = 2;
  const std::vector<double> x = run(s, 30);
  const double t = 30 * s.time.frame;
  EXPECT_NEAR(x[1], -0.5 * 9.81 * t * t, 1e-5);
}

TEST(SecondOrder, LandsWithoutBouncing) {
  Scene s = hanging(8, 1000, 10);
  s.cloths[0].pins.clear();
  s.solver.order = 2;
  Plane plane;
  plane.point = {0, -0.3, 0};
  s.colliders.push_back({plane, {}, 0, {}, false});
  Simulation simulation(s);
  double highest = -1;
  for (int f = 0; f < 90; ++f) {
    simulation.advance_frame();
    if (f < 30) continue;
    for (const double v : simulation.velocities()) highest = std::max(highest, std::abs(v));
  }
  EXPECT_LT(highest, 1e-2);
}

TEST(Tethers, NoParticleIsFartherFromItsPinThanTheSheetIsLong) {
  // The sweeps after the tethers may move a particle a little, those on a border that weigh less more.
  for (const auto& [lumping, share] : {std::pair{Lumping::equal, 1.02}, {Lumping::area, 1.03}}) {
    Scene s = hanging(30, 1e5, 12);
    s.solver.tethers = true;
    s.cloths[0].lumping = lumping;
    s.cloths[0].pins = {{0, 0, {}}};
    Simulation simulation(s);
    for (int f = 0; f < 90; ++f) {
      simulation.advance_frame();
      const std::vector<double> x = simulation.positions();
      for (int j = 0; j < 30; ++j)
        for (int i = 0; i < 30; ++i) {
          const double* p = x.data() + 3 * (j * 30 + i);
          EXPECT_LE(std::hypot(p[0], p[1], p[2]), std::hypot(i / 29.0, j / 29.0) * share + 1e-4);
        }
    }
  }
}

TEST(Tethers, FollowPinsOnTheirPaths) {
  Scene s = hanging(12, 1e5, 6);
  s.solver.tethers = true;
  s.cloths[0].pins = {{0, 0, {{0, {0, 0, 0}}, {0.5, {3, 0, 0}}}}};
  const std::vector<double> x = run(s, 60);
  for (std::size_t p = 0; p < x.size(); p += 3)
    EXPECT_LT(std::hypot(x[p] - 3, x[p + 1], x[p + 2]), std::sqrt(2.0) * 1.02);
}

// Taut on all sides and aslant, so that its rounded places lie beside its plane and beside their distances.
TEST(Tethers, LeaveWhatIsAtRest) {
  for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::line})
    for (const int substeps : {64, 1600}) {
      Scene s = hanging(13, 1000, substeps);
      s.solver.sweep = sweep;
      s.solver.tethers = true;
      s.gravity = {};
      Cloth& cloth = s.cloths[0];
      cloth.grid.origin = {0.3, 1.2, -2};
      cloth.grid.u = {0.5, 0.2, -0.1};
      cloth.grid.v = {0.19, -0.42, 0.11};
      cloth.drag = 0;
      Simulation simulation(s);
      const std::vector<double> start = simulation.positions();
      for (int f = 0; f < 30; ++f) simulation.advance_frame();
      const std::vector<double> end = simulation.positions();
      for (std::size_t k = 0; k < end.size(); ++k) EXPECT_NEAR(end[k], start[k], 5e-5) << substeps;
    }
}

TEST(LineRuns, HashesDependOnNeitherThreadsNorInstructionSet) {
  Scene s = hanging(70, 1e5, 4);
  s.solver.order = 2;
  s.solver.tethers = true;
  s.cloths[0].bending = 1e-4;
  s.cloths[0].strain_limit = 0.1;
  s.colliders.push_back({Sphere{{0.5, -0.3, 0.5}, 0.2}, {}, 0.01, {}, false});
  for (const int iterations : {1, 2}) {
    s.solver.iterations = iterations;
    std::uint64_t expected = 0;
    for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512})
      for (const int threads : {1, 2, 3}) {
        if (!simd_available(simd)) continue;
        Options options;
        options.simd = simd;
        options.threads = threads;
        Simulation simulation(s, options);
        for (int f = 0; f < 12; ++f) simulation.advance_frame();
        ASSERT_TRUE(simulation.status().ok) << simulation.status().text;
        if (expected == 0) expected = simulation.hash();
        EXPECT_EQ(simulation.hash(), expected) << simd_name(simd) << ", " << threads << " threads";
      }
  }
}

TEST(LineRuns, TheInextensibleSceneHardlyStretches) {
  Simulation simulation(read_scene("inextensible").scene);
  double greatest = 0;
  for (int f = 0; f < 120; ++f) {
    simulation.advance_frame();
    if (f >= 30) greatest = std::max(greatest, simulation.report().strain.max);
  }
  ASSERT_TRUE(simulation.status().ok) << simulation.status().text;
  std::printf("greatest strain %.2f %% from 0.5 s on, %.2f %% at the end\n", 100 * greatest,
              100 * simulation.report().strain.max);
  EXPECT_LT(greatest, 0.01);
}

// A collider that nothing comes near asks for velocities in every substep; without one they are
// only written at the end of the frame.
TEST(LineRuns, VelocitiesThatWaitForTheFramesEndChangeNothing) {
  for (const Method method : {Method::positional, Method::compliant})
    for (const Sweep sweep : {Sweep::line, Sweep::gauss_seidel, Sweep::jacobi})
      for (const int order : {1, 2}) {
        if (order == 2 && (method == Method::positional || sweep == Sweep::jacobi)) continue;
        Scene s = hanging(20, 1e4, 5);
        s.solver.method = method;
        s.solver.sweep = sweep;
        s.solver.order = order;
        s.solver.tethers = true;
        s.cloths[0].drag = 0.5;
        s.cloths[0].bending = 1e-4;
        Simulation waits(s);
        s.colliders.push_back({});
        s.colliders[0].shape = Plane{{0, -50, 0}, {0, 1, 0}};
        Simulation writes(s);
        for (int f = 0; f < 20; ++f) {
          waits.advance_frame();
          writes.advance_frame();
        }
        ASSERT_EQ(waits.plan().fallback, writes.plan().fallback);
        EXPECT_EQ(waits.positions(), writes.positions())
            << int(method) << " " << int(sweep) << " order " << order;
        EXPECT_EQ(waits.velocities(), writes.velocities())
            << int(method) << " " << int(sweep) << " order " << order;
      }
}

TEST(LineRuns, ThePlanNamesTheStages) {
  Scene s = hanging(10, 1e5, 4);
  s.solver.tethers = true;
  s.cloths[0].bending = 1e-4;
  const Simulation simulation(s);
  std::vector<std::string> names;
  for (const PlannedStage& p : simulation.plan().stages) names.push_back(p.name);
  EXPECT_EQ(names, (std::vector<std::string>{"predict", "tethers", "line", "bending", "velocity"}));
}

// A straight chain whose ends come nearer.
Scene pressed_chain(double k, int order, int substeps, double length = 1.1) {
  Scene s;
  s.solver.method = Method::compliant;
  s.solver.sweep = Sweep::line;
  s.solver.order = order;
  s.time.substeps = substeps;
  Cloth c;
  c.grid = {65, 2, {0, 0, 0}, {length, 0, 0}, {0, 0, 0.1}, 0};
  c.particle_mass = 0.001;
  c.stiffness = {k, 0, 0};
  c.drag = 4;
  for (const int j : {0, 1}) {
    c.pins.push_back({0, j, {}});
    c.pins.push_back({64, j, {{0, {length, 0, 0.1 * j}}, {0.5, {1, 0, 0.1 * j}}}});
  }
  s.cloths.push_back(c);
  return s;
}

// Five seconds of it, of both orders, and of chains a hair apart: how they jitter is chance.
template <class Expect>
void run_pressed_chains(const std::vector<double>& stiffness, const std::vector<int>& substeps,
                        const Expect& expect) {
  for (const int order : {1, 2})
    for (const double k : stiffness)
      for (const int count : substeps)
        for (const double length : {1.1, 1.100011, 1.100022, 1.100033}) {
          Simulation simulation(pressed_chain(k, order, count, length));
          for (int f = 0; f < 300; ++f) simulation.advance_frame();
          SCOPED_TRACE("order " + std::to_string(order) + ", " + std::to_string(k) + " N/m, " +
                       std::to_string(count) + " substeps, " + std::to_string(length) + " m");
          EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
          expect(simulation, order, count);
        }
}

// One Newton step a substep finds no way out of the line and overshoots. The frames in which it does
// are run again with more substeps.
TEST(LineRuns, PressedChainBucklesAndHangs) {
  run_pressed_chains({1e5, 1e7, 1e9}, {4, 5, 6, 8}, [](const Simulation& simulation, int, int) {
    EXPECT_LT(simulation.report().strain.max, 0.005);
    EXPECT_LT(simulation.report().energy.kinetic, 1e-3);
  });
}

// With so few substeps that 16 times as many are not enough, coloured sweeps take over. What jitters within
// all bounds is told by what drag should have taken.
TEST(LineRuns, PressedChainHangsByOtherSweepsWithFewSubsteps) {
  run_pressed_chains({1e3, 1e5, 1e7, 1e9}, {1, 2, 3}, [](const Simulation& simulation, int, int) {
    EXPECT_TRUE(simulation.plan().fallback);
    EXPECT_LT(simulation.report().strain.max, 0.1);
    EXPECT_LT(simulation.report().energy.kinetic, 1e-3);
  });
}

// A run that goes back to an earlier snapshot begins with the sweeps that the scene asks for.
TEST(LineRuns, LinesComeBackWithAnEarlierSnapshot) {
  Simulation simulation(pressed_chain(1e7, 2, 1));
  const Snapshot start = simulation.snapshot();
  const auto has_line = [&] {
    const auto& stages = simulation.plan().stages;
    return std::any_of(stages.begin(), stages.end(),
                       [](const auto& s) { return s.name == "line"; });
  };
  EXPECT_TRUE(has_line());
  for (int f = 0; f < 300; ++f) simulation.advance_frame();
  EXPECT_FALSE(has_line());
  const std::uint64_t hash = simulation.hash();
  simulation.restore(start);
  EXPECT_TRUE(has_line());
  for (int f = 0; f < 300; ++f) simulation.advance_frame();
  EXPECT_FALSE(has_line());
  EXPECT_EQ(simulation.hash(), hash);
}

}  // namespace
}  // namespace weft
