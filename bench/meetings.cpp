// Random scenes of sheets that meet (meetings.h).
#include "meetings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "weft/random.h"
#include "weft/simulation.h"

namespace bench {
namespace {

using weft::Cloth;
using weft::Method;
using weft::Random;
using weft::Scene;
using weft::SelfCollisionMode;
using weft::Sweep;
using weft::Vec3;

double between(Random& random, double least, double most) {
  return least + (most - least) * random.unit();
}

double log_between(Random& random, double least, double most) {
  return least * std::pow(most / least, random.unit());
}

int pick(Random& random, int count) {
  return int(random.unit() * count);
}

Vec3 plus(const Vec3& a, const Vec3& b, double times) {
  return {a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]};
}

double greatest_side(const Scene& scene) {
  double side = 0;
  for (const Cloth& c : scene.cloths)
    side = std::max({side, weft::length(c.grid.u), weft::length(c.grid.v)});
  return side;
}

bool projects(const Scene& scene) {
  return scene.solver.method == Method::compliant || scene.solver.method == Method::positional;
}

void random_method(Random& random, Scene& scene) {
  weft::Solver& s = scene.solver;
  constexpr Method kMethods[] = {Method::spring,    Method::spring,    Method::spring_friction,
                                 Method::compliant, Method::compliant, Method::positional};
  s.method = kMethods[pick(random, 6)];
  const bool swept = projects(scene);
  if (s.method == Method::compliant) s.sweep = static_cast<Sweep>(pick(random, 3));
  if (s.method == Method::compliant && s.sweep == Sweep::gauss_seidel)
    s.order = 1 + pick(random, 2);
  s.iterations = swept ? 1 + pick(random, 6) : 1;
  scene.time.substeps = swept ? 24 + pick(random, 60) : weft::kAutoSubsteps;
}

// One sheet about (0, height, 0), turned about the vertical and tilted; returns how far it reaches above
// and below that height.
double random_sheet(Random& random, double spacing, double height, Cloth& cloth) {
  const int nx = 4 + pick(random, 12), ny = 4 + pick(random, 12);
  const double turn = between(random, 0, 2 * std::numbers::pi), tilt = between(random, -0.2, 0.2);
  const double side[2] = {spacing * between(random, 0.7, 1.3) * (nx - 1),
                          spacing * between(random, 0.7, 1.3) * (ny - 1)};
  const Vec3 along{std::cos(turn), 0, std::sin(turn)};
  const Vec3 across{-std::sin(turn) * std::cos(tilt), std::sin(tilt),
                    std::cos(turn) * std::cos(tilt)};
  const double flip = pick(random, 2) ? 1 : -1;
  for (std::size_t k = 0; k < 3; ++k) {
    cloth.grid.u[k] = side[0] * along[k];
    cloth.grid.v[k] = flip * side[1] * across[k];
  }
  const double away = 0.5 * spacing;
  const Vec3 middle{between(random, -away, away), height, between(random, -away, away)};
  cloth.grid.origin = plus(plus(middle, cloth.grid.u, -0.5), cloth.grid.v, -0.5);
  cloth.grid.nx = nx;
  cloth.grid.ny = ny;
  return std::abs(0.5 * side[1] * std::sin(tilt));
}

void random_material(Random& random, const Scene& scene, Cloth& cloth) {
  cloth.density = log_between(random, 0.1, 1);
  const double stiffness = log_between(random, 100, 5000);
  if (scene.solver.method == Method::spring && pick(random, 3) == 0)
    cloth.membrane = {stiffness, 0.7 * stiffness, 0.1 * stiffness, 0.2 * stiffness, 0};
  else
    cloth.stiffness = {stiffness, 0.5 * stiffness, pick(random, 2) ? 0.2 * stiffness : 0.0};
  if (pick(random, 3) == 0) cloth.bending = {log_between(random, 1e-6, 1e-3)};
}

}  // namespace

Scene random_meeting(std::uint64_t number) {
  Random random(37, number);
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.solver.sleep = 0;
  random_method(random, scene);
  const double spacing = log_between(random, 0.005, 0.05);
  const auto mode = pick(random, 3) ? SelfCollisionMode::surface : SelfCollisionMode::particles;
  const double thickness = spacing * log_between(random, 0.2, 1.8);
  const double friction = pick(random, 2) ? between(random, 0, 0.6) : 0;
  const double speed = log_between(random, 0.25, 5);
  const int sheets = 2 + pick(random, 4);
  double height = 0, below = 0;
  for (int n = 0; n < sheets; ++n) {
    Cloth cloth;
    const double reach = random_sheet(random, spacing, 0, cloth);
    if (n > 0) height += below + reach + thickness * between(random, 1.1, 2);
    cloth.grid.origin[1] += height;
    below = reach;
    random_material(random, scene, cloth);
    cloth.self_collision.mode = mode;
    cloth.self_collision.thickness = thickness;
    cloth.self_collision.friction = friction;
    scene.cloths.push_back(cloth);
  }
  // The lowest goes up, the highest down, and others in between.
  for (int n = 0; n < sheets; ++n)
    scene.cloths[std::size_t(n)].velocity = {0.2 * speed * random.symmetric(),
                                             speed * (0.5 - double(n) / (sheets - 1)),
                                             0.2 * speed * random.symmetric()};
  // All have met by then, and moved on for a while.
  scene.time.seconds = std::clamp(1.5 * height / speed, 0.1, 0.5);
  return scene;
}

std::string meeting_name(const Scene& scene) {
  const Cloth& c = scene.cloths[0];
  const double spacing = spacing_u(c.grid);
  char text[240];
  std::snprintf(text, sizeof text,
                "%d sheets, %s, method %d sweep %d order %d, substeps %d, %s, thickness %.3g of "
                "%.3g m, %.3g m/s, friction %.2g",
                int(scene.cloths.size()),
                c.self_collision.mode == SelfCollisionMode::surface ? "surface" : "particles",
                int(scene.solver.method), int(scene.solver.sweep), scene.solver.order,
                scene.time.substeps, c.membrane.given() ? "membrane" : "springs",
                c.self_collision.thickness / spacing, spacing, 2 * c.velocity[1],
                c.self_collision.friction);
  return text;
}

Meeting run_meeting(const Scene& scene, int threads) {
  weft::Options options;
  options.threads = threads;
  weft::Simulation simulation(scene, options);
  const weft::Report start = simulation.report();
  double motion = 0;
  for (const Cloth& c : scene.cloths)
    motion +=
        c.density * weft::length(c.grid.u) * weft::length(c.grid.v) * weft::length(c.velocity);
  const double side = greatest_side(scene);
  Meeting m;
  while (m.finite && simulation.time() < scene.time.seconds - 1e-9) {
    simulation.advance_frame();
    const weft::Report r = simulation.report();
    m.finite = r.finite && r.status.ok;
    m.met |= r.contact.energy_taken != 0;
    m.clamped |= r.contact.greatest_clamp > 0;
    // Methods that project leave constraints with an error at a frame's end, which counts as energy in
    // springs as stiff as that; of them it is motion that must not grow.
    const double energy = projects(scene) ? r.energy.kinetic : r.energy.total;
    m.gain = std::max(m.gain, energy / start.energy.total - 1);
    m.strain = std::max(m.strain, r.strain.max);
    m.crossings = std::max(m.crossings, r.penetration.crossings);
    for (std::size_t k = 0; k < 3; ++k) {
      m.linear = std::max(m.linear, std::abs(r.momentum[k] - start.momentum[k]) / motion);
      m.angular = std::max(
          m.angular, std::abs(r.angular_momentum[k] - start.angular_momentum[k]) / (motion * side));
    }
  }
  return m;
}

std::string broken_laws(const Scene& scene, const Meeting& m) {
  std::string broken;
  const auto expect = [&](bool kept, const char* what, double figure) {
    if (kept) return;
    char text[80];
    std::snprintf(text, sizeof text, "%s%s %.3g", broken.empty() ? "" : ", ", what, figure);
    broken += text;
  };
  // The sweeps of lines keep momentum to single precision of forces that are much greater than the blow. What
  // moves as one, so that nothing passes, keeps its turn alone; and so do positions that are put apart, by two
  // thicknesses a second at most, while the things slide on each other.
  const weft::Solver& solver = scene.solver;
  const bool lines = solver.method == Method::compliant && solver.sweep == Sweep::line;
  const weft::SelfCollision& self = scene.cloths[0].self_collision;
  expect(m.finite, "not finite", 0);
  expect(m.met, "does not meet", 0);
  expect(m.gain <= 1e-3, "energy gained", m.gain);
  expect(m.linear <= (lines ? 5e-4 : 2e-6), "linear momentum", m.linear);
  const double slid = 2 * self.thickness * scene.time.seconds / greatest_side(scene);
  if (self.friction == 0 && !m.clamped)
    expect(m.angular <= 1e-3 + slid, "angular momentum", m.angular);
  if (self.mode == SelfCollisionMode::surface)
    expect(m.crossings == 0, "crossings", double(m.crossings));
  return broken;
}

}  // namespace bench
