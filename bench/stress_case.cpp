// Runs stress cases and judges them (stress_case.h).
#include "stress_case.h"

#include <algorithm>
#include <cmath>

#include "energy_ledger.h"
#include "peer.h"
#include "weft/random.h"
#include "weft/simulation.h"

namespace bench {
namespace {

using weft::Random;

constexpr int kLeastSubsteps = 60;  // of a run
constexpr double kJitter = 0.3;     // of the spacing, where the sheet is to tear

std::vector<Vec3> as_points(const std::vector<double>& flat) {
  std::vector<Vec3> points(flat.size() / 3);
  for (std::size_t n = 0; n < flat.size(); ++n) points[n / 3][n % 3] = flat[n];
  return points;
}

std::vector<double> as_values(const std::vector<Vec3>& points) {
  std::vector<double> flat;
  for (const Vec3& p : points) flat.insert(flat.end(), p.begin(), p.end());
  return flat;
}

bool is_spring(const weft::Scene& scene) {
  return scene.solver.method == weft::Method::spring ||
         scene.solver.method == weft::Method::spring_friction;
}

// Positions at the start; pinned particles stay where the grid has them.
std::vector<Vec3> start_positions(const StressCase& c) {
  const weft::Cloth& cloth = c.scene.cloths[0];
  const weft::Grid& g = cloth.grid;
  Random random(c.seed, 1);
  std::vector<Vec3> x;
  const double spacing = std::min(spacing_u(g), spacing_v(g));
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      Vec3 p = grid_point(g, i, j);
      if (c.start == Start::folded && 2 * j > g.ny - 1) {
        p = grid_point(g, i, g.ny - 1 - j);
        p[1] -= 0.02 * spacing;
      }
      if (c.start == Start::coincident) p = grid_point(g, 0.5 * (g.nx - 1), 0.5 * (g.ny - 1));
      if (c.start == Start::shreds)
        for (double& k : p) k += kJitter * spacing * random.symmetric();
      x.push_back(pinned(cloth, i, j) ? grid_point(g, i, j) : p);
    }
  return x;
}

std::vector<Vec3> start_velocities(const StressCase& c) {
  const weft::Cloth& cloth = c.scene.cloths[0];
  Random random(c.seed, 2);
  std::vector<Vec3> v;
  for (int j = 0; j < cloth.grid.ny; ++j)
    for (int i = 0; i < cloth.grid.nx; ++i) {
      Vec3 here{};
      for (double& k : here) k = c.speed * random.symmetric();
      v.push_back(pinned(cloth, i, j) ? Vec3{} : here);
    }
  return v;
}

// The scene of a case with what its start needs: a ball in the sheet, constraints that tear.
weft::Scene scene_of(const StressCase& c) {
  weft::Scene scene = c.scene;
  weft::Cloth& cloth = scene.cloths[0];
  const weft::Grid& g = cloth.grid;
  if (c.start == Start::inside) {
    weft::Collider ball;
    ball.shape = weft::Sphere{grid_point(g, 0.5 * (g.nx - 1), 0.5 * (g.ny - 1)),
                              0.3 * std::min(weft::length(g.u), weft::length(g.v))};
    scene.colliders.push_back(ball);
  }
  if (c.start == Start::shreds) cloth.tear_strain = 0.05;
  return scene;
}

int frames_of(const StressCase& c, int substeps) {
  const double frame = c.scene.time.frame;
  return int(std::ceil(std::max(c.seconds, kLeastSubsteps * frame / substeps) / frame - 1e-9));
}

}  // namespace

const char* start_name(Start start) {
  const char* const names[] = {"flat", "folded", "inside a ball", "coincident", "shreds"};
  return names[int(start)];
}

const char* fate_name(Fate fate) {
  const char* const names[kFates] = {"stable", "saved", "refused", "unbounded", "not finite"};
  return names[int(fate)];
}

Verdict run_stress(const StressCase& c) {
  const weft::Scene scene = scene_of(c);
  Verdict verdict;
  if (const auto faults = validate(scene); !faults.empty()) {
    verdict.fate = Fate::refused;
    verdict.why = faults[0].place + ": " + faults[0].what;
    return verdict;
  }
  weft::Options options;
  options.threads = 1;
  weft::Simulation simulation(scene, options);
  const std::vector<Vec3> x = start_positions(c), v = start_velocities(c);
  simulation.set_state(as_values(x), as_values(v));
  bool springs = runs_springs(simulation);
  Ledger ledger(scene, springs, simulation.dt());
  ledger.open(x, v);
  for (int frame = frames_of(c, simulation.substeps()); frame > 0; --frame) {
    simulation.advance_frame();
    if (!simulation.status().ok) {
      verdict.fate = Fate::not_finite;
      verdict.why = simulation.status().text;
      return verdict;
    }
    if (springs && !runs_springs(simulation)) {
      springs = false;
      ledger.project_every(simulation.dt());
    }
    verdict.energy = std::max(
        verdict.energy,
        ledger.balance(as_points(simulation.positions()), as_points(simulation.velocities()))
            .share());
  }
  if (simulation.plan().fallback) verdict.fate = Fate::saved;
  if (!(verdict.energy <= kBound)) verdict.fate = Fate::unbounded;
  return verdict;
}

Verdict run_course_stress(const StressCase& c) {
  const weft::Scene scene = scene_of(c);
  const int substeps = std::max(1, scene.time.substeps);
  const auto peer = make_course_peer(scene, substeps);
  const std::vector<Vec3> x = start_positions(c), v = start_velocities(c);
  peer->set_state(as_values(x), as_values(v));
  Ledger ledger(scene, is_spring(scene), scene.time.frame / substeps);
  ledger.open(x, v);
  Verdict verdict;
  for (int frame = frames_of(c, substeps); frame > 0; --frame) {
    peer->advance_frame();
    const double share =
        ledger.balance(as_points(peer->positions()), as_points(peer->velocities())).share();
    if (!std::isfinite(share)) {
      verdict.fate = Fate::not_finite;
      return verdict;
    }
    verdict.energy = std::max(verdict.energy, share);
  }
  if (verdict.energy > kBound) verdict.fate = Fate::unbounded;
  return verdict;
}

weft::Scene stress_sheet(int n, double spacing, double particle_mass, bool held) {
  weft::Scene scene;
  weft::Cloth cloth;
  const double side = spacing * (n - 1);
  cloth.grid = {n, n, {-side / 2, 0, -side / 2}, {side, 0, 0}, {0, 0, side}, 0};
  cloth.particle_mass = particle_mass;
  for (int i = 0; held && i < n; ++i) cloth.pins.push_back({i, 0, {}});
  scene.cloths.push_back(cloth);
  scene.time.seconds = 1;
  return scene;
}

}  // namespace bench
