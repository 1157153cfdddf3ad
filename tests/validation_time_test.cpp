// Integration in time against closed forms: free fall, the period of one spring, a pendulum, the
// stability limit, what is conserved.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "made_up_mesh.h"
#include "mesh_scenes.h"
#include "physics/model/lattice/energy.h"
#include "sheets.h"
#include "truth.h"

namespace weft {
namespace {

constexpr double kPi = std::numbers::pi;

// x0 + v0 t + g t²/2 after half a second.
TEST(FreeFall, IsThatOfGalilei) {
  for (const int substeps : {1, 10, 100, 1000}) {
    Scene scene;
    scene.cloths.emplace_back();
    scene.cloths[0].grid = {20, 5, {0, 0, 0}, {1, 0, 0}, {0, 0, 0.25}, 0};
    scene.cloths[0].stiffness = {0.001, 0.001, 0};
    scene.cloths[0].particle_mass = 0.1;
    scene.time = {0.5, substeps, 5};
    Simulation simulation(scene);
    set_velocity(simulation, {0, 1.3, 0});
    simulation.advance_frame();
    // Positions of 1 m and velocities of 4 m/s round by 6e-8 m and 2.4e-7 m/s a substep.
    expect({"free fall", "spring, " + std::to_string(substeps) + " substeps",
            0.5 * 1.3 - 0.125 * 9.81, 2e-5, "m"},
           position(simulation, 7, 2)[1]);
  }
}

// What a plan tells of speeds that single precision does not move; none: 0 [m/s].
double told_of_rounding(const Simulation& simulation) {
  for (const std::string& note : simulation.plan().notes)
    if (note.find("single precision does not move") != std::string::npos) {
      const std::string words = "slower than ";
      return std::stod(note.substr(note.find(words) + words.size()));
    }
  return 0;
}

// What single precision cannot move in a substep is kept for the next.
TEST(FreeFall, IsThatOfGalileiInFineSubsteps) {
  for (const Method method : {Method::spring, Method::positional, Method::compliant})
    for (const double size : {0.7, 6.0})
      for (const int substeps : {1, 100}) {
        Scene scene;
        scene.cloths.emplace_back();
        scene.cloths[0].grid = {9, 6, {-size, size, -size}, {size, 0, 0}, {0, 0, size}, 0};
        scene.cloths[0].stiffness = {0.001, 0.001, 0};
        // Another as far below: heights are counted from zero.
        scene.cloths.push_back(scene.cloths[0]);
        scene.cloths[1].grid.origin[1] = -size;
        scene.solver.method = method;
        scene.time = {1e-4, substeps, 5};
        Simulation simulation(scene);
        constexpr int kFrames = 10;
        for (int n = 0; n < kFrames; ++n) simulation.advance_frame();
        const double fall = 9.81 * std::pow(kFrames * 1e-4, 2) / 2;
        EXPECT_EQ(told_of_rounding(simulation), 0);
        EXPECT_NEAR(size - position(simulation, 4, 3)[1], fall, 10 * 2.4e-7)
            << int(method) << ", " << size << ", " << substeps;
      }
}

// Sweeps over meshes keep nothing: the plan says below which speed they stay where they are. Forces do.
TEST(FreeFall, SaysWhereSubstepsOfMeshesAreTooShort) {
  for (const Method method : {Method::spring, Method::compliant})
    for (const double drag : {0.0, 1.0})
      for (const int substeps : {1, 100}) {
        Scene scene = scene_of(made_up({}));
        scene.cloths[0].stiffness.structural = 0.001;
        scene.cloths[0].drag = drag;
        scene.solver.method = method;
        scene.time = {1e-4, substeps, 5};
        EXPECT_EQ(told_of_rounding(Simulation(scene)) > 0,
                  substeps > 1 && method == Method::compliant)
            << int(method) << ", " << drag << ", " << substeps;
      }
}

std::vector<Solver> solvers() {
  const auto solver = [](Method method, Sweep sweep, int order, int iterations) {
    Solver s;
    s.method = method;
    s.sweep = sweep;
    s.order = order;
    s.iterations = iterations;
    return s;
  };
  using enum Method;
  using enum Sweep;
  return {solver(spring, gauss_seidel, 1, 1),     solver(spring_friction, gauss_seidel, 1, 1),
          solver(positional, gauss_seidel, 1, 1), solver(positional, jacobi, 1, 2),
          solver(positional, line, 1, 1),         solver(compliant, gauss_seidel, 1, 1),
          solver(compliant, gauss_seidel, 1, 3),  solver(compliant, jacobi, 1, 2),
          solver(compliant, line, 1, 1),          solver(compliant, gauss_seidel, 2, 1),
          solver(compliant, line, 2, 1)};
}

// By every method, whatever the substep, from rest and thrown, alone or as a state that was set.
TEST(FreeFall, IsExactByEveryMethod) {
  for (const Solver& s : solvers())
    for (const double stiffness : {0.001, 1e5})
      for (const int substeps : {1, 7, 100})
        for (const double thrown : {0.0, 1.3}) {
          Scene scene;
          scene.solver = s;
          scene.cloths.emplace_back();
          scene.cloths[0].grid = {20, 5, {0, 0, 0}, {1, 0, 0}, {0, 0, 0.25}, 0};
          scene.cloths[0].stiffness = {stiffness, stiffness, 0};
          scene.cloths[0].density = 0.3;
          scene.time = {1.0 / 60, substeps, 5};
          Simulation simulation(scene);
          if (thrown > 0) set_velocity(simulation, {0, thrown, 0});
          for (int frame = 0; frame < 30; ++frame) simulation.advance_frame();
          const double t = simulation.time();
          // 3000 roundings of positions of 1 m.
          for (const int i : {0, 7, 19})
            EXPECT_NEAR(position(simulation, i, 2)[1], thrown * t - 0.5 * 9.81 * t * t, 1e-4)
                << int(s.method) << " " << int(s.sweep) << " order " << s.order << ", " << stiffness
                << " N/m, " << substeps << " substeps, " << thrown << " m/s";
        }
}

// So is a fall from a state that is set while the run goes on, one that goes on from a snapshot of it, and
// one that another method goes on with.
TEST(FreeFall, IsExactFromWhereItIsTakenUp) {
  const auto fall = [](Simulation& simulation, double y, double v) {
    const double start = simulation.time();
    for (int frame = 0; frame < 20; ++frame) simulation.advance_frame();
    const double t = simulation.time() - start;
    return position(simulation, 7, 2)[1] - (y + v * t - 0.5 * 9.81 * t * t);
  };
  for (const Solver& s : solvers())
    for (const int substeps : {1, 7, 100}) {
      Scene scene;
      scene.solver = s;
      scene.cloths.emplace_back();
      scene.cloths[0].grid = {20, 5, {0, 0, 0}, {1, 0, 0}, {0, 0, 0.25}, 0};
      scene.cloths[0].stiffness = {10, 10, 0};
      scene.time = {1.0 / 60, substeps, 5};
      Simulation simulation(scene);
      const std::vector<double> start = simulation.positions();
      for (int frame = 0; frame < 10; ++frame) simulation.advance_frame();
      std::vector<double> thrown(start.size(), 0);
      for (std::size_t n = 1; n < thrown.size(); n += 3) thrown[n] = 1.3;
      simulation.set_state(start, thrown);
      const Snapshot set = simulation.snapshot();
      const std::string what = std::to_string(int(s.method)) + " " + std::to_string(int(s.sweep)) +
                               " order " + std::to_string(s.order) + ", " +
                               std::to_string(substeps) + " substeps";
      EXPECT_NEAR(fall(simulation, 0, 1.3), 0, 1e-4) << what;
      Simulation other(scene);
      other.restore(set);
      EXPECT_NEAR(fall(other, 0, 1.3), 0, 1e-4) << what << ", from a snapshot";
      EXPECT_EQ(other.hash(), simulation.hash()) << what;
      for (const Solver& next : {solvers()[0], solvers()[5]}) {
        Simulation changed(scene);
        for (int frame = 0; frame < 10; ++frame) changed.advance_frame();
        Scene by = scene;
        by.solver = next;
        changed.set_scene(by);
        const double t = changed.time();
        EXPECT_NEAR(fall(changed, -0.5 * 9.81 * t * t, -9.81 * t), 0, 1e-4)
            << what << ", then " << int(next.method) << " order " << next.order;
      }
    }
}

TEST(OneSpring, PeriodConvergesWithTheSquareOfTheSubstep) {
  const double truth = 2 * kPi * std::sqrt(0.1 / 10);
  double before = 0;
  for (int n = 20; n <= 320; n *= 2) {
    const double error =
        show({"one spring, period", "spring, " + std::to_string(n) + " substeps a period", truth,
              0.01, "s"},
             ten_periods(truth / n) / 10);
    if (before > 0)
      expect({"one spring, period",
              "order from " + std::to_string(n / 2) + " to " + std::to_string(n) + " substeps", 2,
              0.05, "log₂"},
             std::log2(before / error));
    before = error;
  }
}

// Time that a rigid link takes from level to plumb: a quarter of the period.
double quarter_period(const Solver& solver, int substeps) {
  Scene scene;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {2, 2, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.particle_mass = 0.1;
  cloth.stiffness = {1e8, 0, 0};
  cloth.pins = {{0, 0, {}}, {0, 1, {}}};
  scene.solver = solver;
  scene.time = {0.6 / substeps, 1, 10};
  Simulation simulation(scene);
  double x[3] = {1, 1, 1};  // of the last three frames, for a parabola through them
  for (;;) {
    simulation.advance_frame();
    x[0] = x[1], x[1] = x[2], x[2] = position(simulation, 1, 0)[0];
    if (x[2] > 0) continue;
    const double slope = (x[2] - x[0]) / 2, bend = x[2] - 2 * x[1] + x[0];
    double t = -x[1] / (x[2] - x[1]);
    for (int n = 0; n < 20; ++n) t -= (x[1] + slope * t + bend * t * t / 2) / (slope + bend * t);
    return simulation.time() + (t - 1) * scene.time.frame;
  }
}

void pendulum(const std::string& name, const Solver& solver, double order, double goal) {
  const double truth = std::sqrt(1 / 9.81) * 1.8540746773;
  double before = 0;
  for (const int substeps : {50, 100, 200, 400}) {
    const double error =
        show({"pendulum on a rigid link, from level to plumb",
              name + ", " + std::to_string(substeps) + " substeps", truth, 0.02, "s"},
             quarter_period(solver, substeps));
    if (before > 0)
      expect({"pendulum on a rigid link, from level to plumb",
              name + ", order from " + std::to_string(substeps / 2), order, goal, "log₂"},
             std::log2(before / error));
    before = error;
  }
}

TEST(Pendulum, ConvergesWithTheOrderOfTheSubstep) {
  Solver solver;
  solver.method = Method::positional;
  pendulum("positional", solver, 1, 0.2);
  solver.method = Method::compliant;
  pendulum("compliant", solver, 1, 0.2);
  solver.order = 2;
  pendulum("compliant, order 2", solver, 2, 0.2);
}

// A column of n springs, one end held: ω² = 4 k/m sin²(π (2n-1)/(4n+2)) at most.
TEST(StabilityLimit, IsThatOfTheStiffestMode) {
  for (const int n : {3, 10, 100}) {
    const Simulation simulation(hanging_column(n, 0.01, 100, 0.05));
    const double omega = 2 * std::sqrt(100 / 0.01) * std::sin(kPi * (2 * n - 1) / (4 * n + 2));
    const double ratio = simulation.plan().dt_limit * omega / 2;
    expect({"stability limit", "column of " + std::to_string(n) + " springs", 2 / omega, 0.1, "s"},
           simulation.plan().dt_limit);
    EXPECT_LE(ratio, 1);
  }
}

// Greatest deviations over a run, as shares; of the energy also the change of its mean from the first
// half to the second.
struct Conserved {
  double energy, trend, own_energy, momentum, angular;
};

// What leapfrog keeps exactly of a linear motion: E - dt²/8 Σ m |a|².
double own_energy(const Simulation& simulation, const std::vector<physics::Stencil>& stencils) {
  const Cloth& cloth = simulation.scene().cloths[0];
  const std::vector<double> flat = simulation.positions();
  std::vector<Vec3> x(flat.size() / 3);
  for (std::size_t n = 0; n < flat.size(); ++n) x[n / 3][n % 3] = flat[n];
  double sum = 0;
  for (const Vec3& f : physics::spring_forces(cloth, stencils, x, nullptr))
    sum += (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) / cloth.particle_mass;
  return simulation.report().energy.total - simulation.dt() * simulation.dt() / 8 * sum;
}

// A free sheet that breathes within its plane at some speed, for 100000 substeps of a share of the limit.
Conserved run_free(int n, double share, double speed) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {n, n, {-0.5, 0, -0.5}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.particle_mass = 0.01;
  cloth.stiffness = {100, 100, 20};
  scene.time = {1, kAutoSubsteps, 100};
  scene.time.substeps = int(std::ceil(1 / share / Simulation(scene).plan().dt_limit));
  Simulation simulation(scene);
  const std::vector<double> x = simulation.positions();
  std::vector<double> v(x.size(), 0.0);
  double flow = 0;
  for (std::size_t c = 0; c < x.size(); ++c)
    if (c % 3 != 1) v[c] = speed * std::sin(kPi * x[c]);
  for (std::size_t c = 0; c < x.size(); c += 3)
    flow += cloth.particle_mass * std::hypot(v[c], v[c + 1], v[c + 2]);
  simulation.set_state(x, v);
  const auto stencils = physics::stencils_of(cloth);
  const Report start = simulation.report();
  const double own = own_energy(simulation, stencils);
  const int frames = 100000 / simulation.substeps();
  Conserved c{};
  double halves[2] = {0, 0};
  for (int frame = 0; frame < frames; ++frame) {
    simulation.advance_frame();
    const Report now = simulation.report();
    const double error = now.energy.total / start.energy.total - 1;
    c.energy = std::max(c.energy, std::abs(error));
    halves[2 * frame / frames] += 2 * error / frames;
    c.own_energy = std::max(c.own_energy, std::abs(own_energy(simulation, stencils) / own - 1));
    for (std::size_t k = 0; k < 3; ++k) {
      c.momentum = std::max(c.momentum, std::abs(now.momentum[k] - start.momentum[k]) / flow);
      c.angular =
          std::max(c.angular, std::abs(now.angular_momentum[k] - start.angular_momentum[k]) / flow);
    }
  }
  c.trend = std::abs(halves[1] - halves[0]);
  return c;
}

// Rounding walks at random, the farther the fewer particles there are: of five starts, the momentum's
// middle one and the greatest of all else.
Conserved run_free(int n, double share) {
  Conserved all{};
  std::array<double, 5> momentum, angular;
  for (std::size_t i = 0; i < momentum.size(); ++i) {
    const Conserved c = run_free(n, share, 0.2 + 0.002 * double(i));
    all.energy = std::max(all.energy, c.energy);
    all.own_energy = std::max(all.own_energy, c.own_energy);
    all.trend = std::max(all.trend, c.trend);
    momentum[i] = c.momentum;
    angular[i] = c.angular;
  }
  std::sort(momentum.begin(), momentum.end());
  std::sort(angular.begin(), angular.end());
  all.momentum = momentum[momentum.size() / 2];
  all.angular = angular[angular.size() / 2];
  return all;
}

// The true energy swings by (ω dt)²/4 in a mode of frequency ω: what is asked of half the limit, a
// thousandth, is out of reach where the sheet is so coarse that its slowest mode has ω dt > 0.06.
TEST(Conservation, OfAFreeSheetFor100000Substeps) {
  const std::tuple<int, double, bool> cases[] = {
      {12, 0.5, false}, {12, 0.125, true}, {48, 0.5, true}};
  for (const auto& [n, share, fine] : cases) {
    const std::string law = "undamped free sheet, 100000 substeps";
    const std::string name = std::to_string(n) + " × " + std::to_string(n) + ", " +
                             (share == 0.5 ? "1/2" : "1/8") + " of the limit: ";
    const Conserved c = run_free(n, share);
    const double energy = show({law, name + "energy", 0, 1e-3, "of E₀"}, c.energy);
    EXPECT_LT(energy, fine ? 1e-3 : 1e-2);
    expect({law, name + "leapfrog's own energy", 0, 1e-3, "of E₀"}, c.own_energy);
    expect({law, name + "energy, change of its mean", 0, 1e-3, "of E₀"}, c.trend);
    expect({law, name + "momentum, median of five starts", 0, 1e-6, "of Σm|v|"}, c.momentum);
    expect({law, name + "angular momentum, median of five starts", 0, 1e-5, "of Σm|v| · 1 m"},
           c.angular);
  }
}

}  // namespace
}  // namespace weft
