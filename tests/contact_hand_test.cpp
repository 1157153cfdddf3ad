// What moves cloth besides contact: grabbing, pins at run time, wind.
#include <cstdio>

#include "cases.h"
#include "contact_scenes.h"
#include "machines.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

Scene sheet(Method method) {
  Scene scene;
  scene.solver.method = method;
  scene.cloths.push_back(flat_sheet(12, 0.5, {0, 0, 0}));
  scene.cloths[0].drag = 2;
  scene.cloths[0].pins = {{0, 0, {}}, {11, 0, {}}};
  return scene;
}

TEST(ContactHand, GrabDrawsAParticleToItsTarget) {
  for (const Method method : {Method::spring, Method::compliant})
    for (const double stiffness : {50.0, 1e7}) {
      Simulation simulation(sheet(method));
      const std::size_t stages = simulation.plan().stages.size();
      simulation.grab(0, 11 * 12 + 6, {0.1, 0.1, 0.2}, stiffness);
      EXPECT_EQ(simulation.plan().stages.size(), stages + 1);
      advance(simulation, 3);
      const Vec3 x = at(simulation.positions(), 11 * 12 + 6);
      EXPECT_LT(std::hypot(x[0] - 0.1, x[1] - 0.1, x[2] - 0.2), 0.1);
      simulation.release();
      EXPECT_EQ(simulation.plan().stages.size(), stages);
      advance(simulation, 6);
      EXPECT_LT(at(simulation.positions(), 11 * 12 + 6)[1], -0.3);
    }
  Simulation simulation(sheet(Method::spring));
  for (const int particle : {-1, 144, 1 << 30})
    EXPECT_THROW(simulation.grab(0, particle, {0, 0, 0}, 1), std::out_of_range);
  EXPECT_THROW(simulation.grab(1, 0, {0, 0, 0}, 1), std::out_of_range);
  EXPECT_THROW(simulation.grab(0, 0, {NAN, 0, 0}, 1), std::invalid_argument);
}

TEST(ContactHand, PinsComeAndGo) {
  Simulation simulation(sheet(Method::spring));
  simulation.pin(0, 65);
  const Vec3 held = at(simulation.positions(), 65);
  advance(simulation, 0.5);
  EXPECT_EQ(at(simulation.positions(), 65), held);
  for (const int particle : {65, 0, 11}) simulation.unpin(0, particle);
  advance(simulation, 1.5);
  EXPECT_LT(at(simulation.positions(), 65)[1], -1);
  EXPECT_TRUE(simulation.status().ok);
}

// What air and hands put into a free sheet, by every method: as much as into springs.
TEST(ContactHand, EveryMethodTakesPushesAlike) {
  const auto momentum = [](const Solver& solver, bool wind, int substeps) {
    Scene scene;
    scene.gravity = {0, 0, 0};
    scene.time.substeps = substeps;
    scene.solver = solver;
    scene.cloths.push_back(flat_sheet(11, 0.5, {0, 0, 0}));
    scene.cloths[0].stiffness = {100, 100, 20};
    if (wind) scene.wind = {{3, 4, 0}, 0.6, 0.3, 0};
    Simulation simulation(scene);
    if (!wind) simulation.grab(0, 60, {0, 1, 0}, 5);
    advance(simulation, 4.0 / 60);
    double sum = 0;
    for (std::size_t p = 0; p < 121; ++p) sum += at(simulation.velocities(), p)[1] / 121;
    return sum;
  };
  const double blown = momentum({}, true, 64), pulled = momentum({}, false, 64);
  EXPECT_GT(blown, 1);
  EXPECT_GT(pulled, 1);
  for (const Method method : {Method::positional, Method::compliant})
    for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::jacobi, Sweep::line})
      for (const int order : {1, 2}) {
        Solver solver;
        solver.method = method;
        solver.sweep = sweep;
        solver.order = order;
        if (order == 2 && (method == Method::positional || sweep == Sweep::jacobi)) continue;
        const std::string which = std::to_string(int(method)) + ", sweep " +
                                  std::to_string(int(sweep)) + ", order " + std::to_string(order);
        // Substeps with velocities from positions, and without.
        for (const int substeps : {16, 64})
          EXPECT_NEAR(momentum(solver, true, substeps), blown, 0.05 * blown) << which;
        // A sheet that gives less follows a pull faster.
        EXPECT_NEAR(momentum(solver, false, 64), pulled, 0.1 * pulled) << which;
      }
}

// Somebody at a shipped scene: pulls at its cloth, moves its first body, carries its pins about.
struct Person {
  enum Does { kPull, kPush, kCarry };
  Scene scene;
  Simulation simulation;
  Vec3 start{};
  double side = 0;  // of the sheet, m

  explicit Person(Scene given) : scene(given), simulation(given) {
    for (int frame = 0; frame < 20; ++frame) simulation.advance_frame();
    const Grid& g = scene.cloths[0].grid;
    start = at(simulation.positions(), std::size_t(g.ny / 2) * g.nx + g.nx / 3);
    side = std::hypot(g.u[0], g.u[1], g.u[2]);
  }
  void move(Does does, const Vec3& offset, const Vec3& velocity) {
    const Grid& g = scene.cloths[0].grid;
    const Vec3 target{start[0] + offset[0], start[1] + offset[1], start[2] + offset[2]};
    if (does == kPull) simulation.grab(0, particle_number(g, g.nx / 3, g.ny / 2), target);
    if (does == kPush) simulation.move_collider(0, target);
    if (does == kCarry) simulation.carry(0, velocity);
    simulation.advance_frame();
  }
  void let_go() {
    simulation.release();
    simulation.carry(0, {});
  }
};

Scene with_lines(Scene scene) {
  scene.solver.method = Method::compliant;
  scene.solver.sweep = Sweep::line;
  scene.time.substeps = 8;
  return scene;
}

// What a hand puts in is no energy from nowhere, while it does and after: nothing falls back.
TEST(ContactHand, StrokesLeaveTheMethodAlone) {
  Cases cases(4);
  for (const char* name : {"swing", "inextensible", "seed1_friction", "seed1_positional", "tug"})
    for (const bool lines : {false, true})
      for (const auto does : {Person::kPull, Person::kPush, Person::kCarry}) {
        const Scene scene = read_scene(name).scene;
        if (!cases.next() || (does == Person::kPush && scene.colliders.empty())) continue;
        Person person(lines ? with_lines(scene) : scene);
        const int substeps = person.simulation.substeps();
        const std::string which =
            name + std::string(lines ? ", lines, " : ", ") + std::to_string(int(does));
        for (int frame = 0; frame < 60; ++frame) {
          // About one and a half strokes a second, half the sheet's side to and fro.
          const double phase = 0.15 * frame, l = person.side;
          person.move(does,
                      {0.5 * l * std::sin(phase), 0.3 * l * std::sin(1.7 * phase),
                       0.4 * l * std::sin(0.8 * phase)},
                      {4 * l * std::cos(phase), 3 * l * std::cos(1.7 * phase),
                       2 * l * std::cos(0.8 * phase)});
          ASSERT_LT(person.simulation.substeps(), 1.5 * substeps) << which;
          ASSERT_FALSE(person.simulation.plan().fallback) << which;
        }
        person.let_go();
        advance(person.simulation, person.simulation.time() + 3);
        EXPECT_FALSE(person.simulation.plan().fallback)
            << which << ": " << person.simulation.plan().notes.back();
        EXPECT_LT(person.simulation.substeps(), 1.5 * substeps) << which;
      }
}

// A hand that tears about beyond all reason heats springs up until they take more substeps, or another
// method; when all is calm again the run goes on as it began.
TEST(ContactHand, WhatItAskedForPasses) {
  Scene scene = read_scene("swing").scene;
  scene.cloths[0].drag = 2;
  // As near to the limit of what a hand may stretch as automatic substeps do not come: there vibrations grow.
  const double stretched = Simulation(scene).plan().dt_limit / std::sqrt(1.6);
  scene.time.substeps = int(std::ceil(scene.time.frame / (0.9 * stretched)));
  Person person(scene);
  const int began = person.simulation.substeps();
  bool fell_back = false;
  for (int frame = 0; frame < 90; ++frame) {
    const double l = frame % 2 == 0 ? person.side : -person.side;
    person.move(Person::kPull, {l, -l, l}, {});
    fell_back |= person.simulation.plan().fallback;
  }
  EXPECT_TRUE(fell_back);
  person.let_go();
  advance(person.simulation, person.simulation.time() + 10);
  EXPECT_FALSE(person.simulation.plan().fallback);
  EXPECT_LT(person.simulation.substeps(), 1.2 * began);
  EXPECT_GT(person.simulation.plan().dt_limit, 0);
}

// A flat sheet in a wind at an angle: the momentum that it gains is that of a flat plate.
TEST(ContactHand, WindPushesLikeOnAFlatPlate) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.time.frame = 1e-4;
  scene.time.substeps = 1;
  scene.cloths.push_back(flat_sheet(21, 0.5, {0, 0, 0}));
  scene.wind = {{3, 4, 0}, 0.6, 0.3, 0};
  Simulation simulation(scene);
  simulation.advance_frame();
  const Vec3 p = simulation.report().momentum;
  // A [drag (u·n)² n + lift (u·n) |u| (n - û (û·n))], u·n = 4, |u| = 5
  const double area = 0.25, dt = 1e-4;
  const double x = area * 0.3 * 4 * 5 * -(0.6 * 0.8);
  const double y = area * (0.6 * 16 + 0.3 * 4 * 5 * (1 - 0.8 * 0.8));
  std::printf("force of the wind %.4f, %.4f N (%.4f, %.4f)\n", p[0] / dt, p[1] / dt, x, y);
  EXPECT_NEAR(p[0] / dt / x, 1, 0.01);
  EXPECT_NEAR(p[1] / dt / y, 1, 0.01);
  // All alike, those at corners and sides, too: it stays flat.
  const std::vector<double> v = simulation.velocities();
  for (std::size_t n = 0; n < 21 * 21; ++n) EXPECT_NEAR(at(v, n)[1] / v[1], 1, 1e-3) << n;
}

// Drawn along by air that blows against it: x = w t - ln(1 + k w t)/k, k the drag over the mass of its area.
TEST(ContactHand, WindDrawsASheetAlongInTheEnd) {
  constexpr double kWind = 5, kDrag = 1, kSeconds = 1.0 / 3;
  for (const int order : {1, 2})
    for (const int substeps : {16, 64, 256}) {
      Scene scene;
      scene.gravity = {};
      scene.time.substeps = substeps;
      scene.solver.method = Method::compliant;
      scene.solver.order = order;
      scene.cloths.push_back(flat_sheet(9, 0.5, {0, 0, 0}));
      scene.cloths[0].density = 0.3;
      scene.cloths[0].drag = 0;
      scene.wind = {{0, kWind, 0}, kDrag, 0, 0};
      Simulation simulation(scene);
      advance(simulation, kSeconds);
      const double k = kDrag / 0.3, t = simulation.time();
      const double expected = kWind * t - std::log(1 + k * kWind * t) / k;
      const double most = order == 2 ? 3e-4 : 0.04 / substeps;
      for (std::size_t n = 0; n < 81; ++n)
        EXPECT_NEAR(at(simulation.positions(), n)[1], expected, most) << order << " " << substeps;
    }
}

// Air at rest slows a sheet down and never turns it back, however light it is.
TEST(ContactHand, DragNeverTurnsASheetBack) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.time.substeps = 20;
  scene.cloths.push_back(flat_sheet(8, 0.5, {0, 0, 0}));
  scene.cloths[0].density = 0.001;
  scene.cloths[0].stiffness = {0.1, 0.1, 0};
  scene.wind.drag = 50;
  Simulation simulation(scene);
  std::vector<double> x = simulation.positions(), v(x.size());
  for (std::size_t k = 1; k < v.size(); k += 3) v[k] = -10;
  simulation.set_state(x, v);
  advance(simulation, 0.5);
  EXPECT_LT(simulation.report().energy.total, 0.5 * 0.00025 * 100);
  for (std::size_t p = 0; p < 64; ++p) EXPECT_LT(at(simulation.velocities(), p)[1], 0.5);
}

TEST(ContactHand, GustsFollowTheSeedAndNothingElse) {
  Scene scene = sheet(Method::spring);
  scene.cloths[0] = flat_sheet(70, 1, {0, 0, 0});
  scene.cloths[0].pins = {{0, 0, {}}, {69, 0, {}}};
  scene.wind = {{4, 0, 2}, 0.5, 0.2, 0.6};
  const auto hash_of = [&](const Options& options) {
    Simulation simulation(scene, options);
    advance(simulation, 0.3);
    return simulation.hash();
  };
  const std::uint64_t hash = hash_of({});
  for (const Options& o : machines()) EXPECT_EQ(hash_of(o), hash) << o.threads << simd_name(o.simd);
  Options other;
  other.seed = 2;
  EXPECT_NE(hash_of(other), hash);
}

}  // namespace
}  // namespace weft
