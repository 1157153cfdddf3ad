// Runs stress cases and judges them (stress_case.h).
#include "stress_case.h"

#include <algorithm>
#include <cmath>

#include "peer.h"
#include "physics/model/lattice/bending.h"
#include "physics/model/lattice/energy.h"
#include "physics/model/random.h"
#include "weft/simulation.h"

namespace bench {
namespace {

using weft::Vec3;
using weft::physics::Random;

constexpr int kLeastSubsteps = 60;  // of a run
// Of positions, added up over a run, relative to the size of the scene.
constexpr double kRounding = 1e-6;
constexpr double kJitter = 0.3;  // of the spacing, where the sheet is to tear

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

double norm(const Vec3& a) {
  return std::hypot(a[0], a[1], a[2]);
}

double distance(const Vec3& a, const Vec3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

bool is_spring(const weft::Scene& scene) {
  return scene.solver.method == weft::Method::spring ||
         scene.solver.method == weft::Method::spring_friction;
}

bool pinned(const weft::Cloth& cloth, int i, int j) {
  return std::any_of(cloth.pins.begin(), cloth.pins.end(),
                     [&](const weft::Pin& p) { return p.i == i && p.j == j; });
}

Vec3 grid_point(const weft::Grid& g, double i, double j) {
  Vec3 x;
  for (std::size_t c = 0; c < 3; ++c)
    x[c] = g.origin[c] + g.u[c] * i / (g.nx - 1) + g.v[c] * j / (g.ny - 1);
  return x;
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
                              0.3 * std::min(norm(g.u), norm(g.v))};
    scene.colliders.push_back(ball);
  }
  if (c.start == Start::shreds) cloth.tear_strain = 0.05;
  return scene;
}

// Where the colliders put what starts inside them.
void push_out(const weft::Scene& scene, std::vector<Vec3>& x) {
  const weft::Grid& g = scene.cloths[0].grid;
  for (const weft::Collider& c : scene.colliders)
    if (const auto* ball = std::get_if<weft::Sphere>(&c.shape))
      for (std::size_t p = 0; p < x.size(); ++p) {
        if (pinned(scene.cloths[0], int(p) % g.nx, int(p) / g.nx)) continue;
        const double away = distance(x[p], ball->center), target = ball->radius + c.offset;
        if (away >= target) continue;
        for (std::size_t k = 0; k < 3; ++k)
          x[p][k] = away > 0 ? ball->center[k] + (x[p][k] - ball->center[k]) * target / away
                             : ball->center[k] + (k == 1 ? target : 0);
      }
}

// Energies of one sheet as its bound counts them.
class Ledger {
 public:
  // Constraints are springs, or projected every dt [s].
  Ledger(const weft::Scene& scene, bool springs, double dt)
      : scene_(scene),
        cloth_(scene_.cloths[0]),
        stencils_(weft::physics::stencils_of(cloth_)),
        springs_(springs),
        dt_(dt) {}

  void open(std::vector<Vec3> x, const std::vector<Vec3>& v) {
    push_out(scene_, x);
    put_in_ = kinetic(v) + weft::physics::bending_energy(cloth_, x) + elastic(x) + tethered(x);
    highest_ = gravity(x);
  }

  // From here on constraints are projected every dt [s].
  void project_every(double dt) {
    springs_ = false;
    dt_ = dt;
  }

  // The energy of a state in what has been put in so far.
  double share(const std::vector<Vec3>& x, const std::vector<Vec3>& v) {
    const double height = gravity(x);
    highest_ = std::max(highest_, height);
    released_ = std::max(released_, highest_ - height);
    const double kept = cloth_.tear_strain > 0 ? 0 : bent(x) + elastic(x);
    return (kinetic(v) + kept) / (put_in_ + released_ + noise(x));
  }

 private:
  double mass(std::size_t p) const {
    const int i = int(p) % cloth_.grid.nx, j = int(p) / cloth_.grid.nx;
    return pinned(cloth_, i, j) ? 0 : particle_mass(cloth_, i, j);
  }
  double mass_of_all() const {
    double sum = 0;
    for (int j = 0; j < cloth_.grid.ny; ++j)
      for (int i = 0; i < cloth_.grid.nx; ++i) sum += particle_mass(cloth_, i, j);
    return sum;
  }
  double kinetic(const std::vector<Vec3>& v) const {
    double sum = 0;
    for (std::size_t p = 0; p < v.size(); ++p) sum += 0.5 * mass(p) * norm(v[p]) * norm(v[p]);
    return sum;
  }
  double gravity(const std::vector<Vec3>& x) const {
    double sum = 0;
    for (std::size_t p = 0; p < x.size(); ++p)
      for (std::size_t k = 0; k < 3; ++k) sum -= mass(p) * scene_.gravity[k] * x[p][k];
    return sum;
  }
  // What a projection makes of a constraint: the inertia of its ends over dt².
  double rigid(std::size_t a, std::size_t b) const {
    const double ma = mass(a), mb = mass(b);
    return (ma > 0 && mb > 0 ? ma * mb / (ma + mb) : ma + mb) / (dt_ * dt_);
  }
  // Stiffness as the solver feels it.
  double felt(std::size_t a, std::size_t b, double k) const {
    if (springs_) return k;
    if (scene_.solver.method != weft::Method::positional) return std::min(k, rigid(a, b));
    return rigid(a, b) * std::min(1.0, 2 * cloth_.positional_k * scene_.solver.iterations);
  }
  // Energy of bending that is felt for sure: (x₀ - 2x₁ + x₂)², projected by itself, is at most as
  // stiff as m/6dt². Whole lines feel more of it, up to all.
  double bent(const std::vector<Vec3>& x) const {
    const double u = spacing_u(cloth_.grid), v = spacing_v(cloth_.grid);
    const double k = cloth_.bending * std::max(u / v / (v * v), v / u / (u * u));
    const double most = mass_of_all() / double(x.size()) / (6 * dt_ * dt_);
    return weft::physics::bending_energy(cloth_, x) * (springs_ || k <= most ? 1 : most / k);
  }
  // Σ over the constraints of visit(stencil, a, b, stiffness felt).
  template <class Visit>
  double sum_of(Visit&& visit) const {
    double sum = 0;
    for (const weft::physics::Stencil& f : stencils_)
      weft::physics::for_each_constraint(cloth_, f, [&](int a, int b, double k) {
        const auto p = std::size_t(a), q = std::size_t(b);
        sum += visit(f, p, q, felt(p, q, k));
      });
    return sum;
  }
  double elastic(const std::vector<Vec3>& x) const {
    const double limit = 1 + cloth_.strain_limit;
    return sum_of([&](const weft::physics::Stencil& f, std::size_t a, std::size_t b, double k) {
      const double length = distance(x[a], x[b]), c = length - f.rest;
      const double over = length - limit * f.rest;
      const bool limited =
          cloth_.strain_limit > 0 && over > 0 && f.kind != weft::physics::Kind::bend;
      return 0.5 * (k * c * c + (limited ? rigid(a, b) * over * over : 0));
    });
  }
  // What the tethers take back at once.
  double tethered(const std::vector<Vec3>& x) const {
    double sum = 0;
    for (std::size_t p = 0; scene_.solver.tethers && p < x.size(); ++p) {
      double over = 0;
      for (const weft::Pin& pin : cloth_.pins) {
        const int i = int(p) % cloth_.grid.nx, j = int(p) / cloth_.grid.nx;
        const Vec3 at = grid_point(cloth_.grid, pin.i, pin.j);
        over = std::max(over, distance(x[p], at) - distance(grid_point(cloth_.grid, i, j), at));
      }
      sum += 0.5 * mass(p) * over * over / (dt_ * dt_);
    }
    return sum;
  }
  // What rounding of the positions puts into the springs.
  double noise(const std::vector<Vec3>& x) const {
    double size = 1;
    for (const Vec3& p : x) size = std::max(size, norm(p));
    const double off = kRounding * size;
    return sum_of([&](const weft::physics::Stencil&, std::size_t, std::size_t, double k) {
      return 0.5 * k * off * off;
    });
  }

  weft::Scene scene_;
  const weft::Cloth& cloth_;
  std::vector<weft::physics::Stencil> stencils_;
  bool springs_;
  double dt_;
  double put_in_ = 0, highest_ = 0, released_ = 0;  // J
};

bool runs_springs(const weft::Simulation& simulation) {
  const auto& stages = simulation.plan().stages;
  return std::any_of(stages.begin(), stages.end(),
                     [](const auto& s) { return s.name == "springs"; });
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
    verdict.energy = std::max(verdict.energy, ledger.share(as_points(simulation.positions()),
                                                           as_points(simulation.velocities())));
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
    const double share = ledger.share(as_points(peer->positions()), as_points(peer->velocities()));
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
