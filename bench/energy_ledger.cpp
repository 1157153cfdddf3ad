// The bound on the energy of a sheet (energy_ledger.h).
#include "energy_ledger.h"

#include <algorithm>
#include <cmath>

#include "physics/model/lattice/bending.h"
#include "physics/model/lattice/energy.h"
#include "physics/model/lattice/membrane.h"

namespace bench {
namespace {

using weft::distance;

// Of positions, added up over a run, relative to the size of the scene.
constexpr double kRounding = 1e-6;

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

}  // namespace

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

bool runs_springs(const weft::Simulation& simulation) {
  const auto& stages = simulation.plan().stages;
  return std::any_of(stages.begin(), stages.end(),
                     [](const auto& s) { return s.name == "springs" || s.name == "membrane"; });
}

Ledger::Ledger(const weft::Scene& scene, bool springs, double dt)
    : scene_(scene),
      cloth_(scene_.cloths[0]),
      stencils_(weft::physics::stencils_of(cloth_, scene_.solver)),
      springs_(springs),
      dt_(dt) {}

void Ledger::open(std::vector<Vec3> x, const std::vector<Vec3>& v) {
  push_out(scene_, x);
  put_in_ = kinetic(v) + weft::physics::bending_energy(cloth_, x) + elastic(x) + tethered(x);
  highest_ = gravity(x);
}

void Ledger::project_every(double dt) {
  springs_ = false;
  dt_ = dt;
}

Ledger::Balance Ledger::balance(const std::vector<Vec3>& x, const std::vector<Vec3>& v) {
  const double height = gravity(x);
  highest_ = std::max(highest_, height);
  released_ = std::max(released_, highest_ - height);
  const bool whole = cloth_.tear_strain == 0 && cloth_.cuts.empty();
  const double kept = whole ? bent(x) + elastic(x) : 0;
  return {kinetic(v) + kept, put_in_ + released_ + noise(x)};
}

double Ledger::mass(std::size_t p) const {
  const int i = int(p) % cloth_.grid.nx, j = int(p) / cloth_.grid.nx;
  return pinned(cloth_, i, j) ? 0 : particle_mass(cloth_, i, j);
}

double Ledger::mass_of_all() const {
  double sum = 0;
  for (int j = 0; j < cloth_.grid.ny; ++j)
    for (int i = 0; i < cloth_.grid.nx; ++i) sum += particle_mass(cloth_, i, j);
  return sum;
}

double Ledger::kinetic(const std::vector<Vec3>& v) const {
  double sum = 0;
  for (std::size_t p = 0; p < v.size(); ++p) sum += 0.5 * mass(p) * weft::dot(v[p], v[p]);
  return sum;
}

double Ledger::gravity(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (std::size_t p = 0; p < x.size(); ++p)
    for (std::size_t k = 0; k < 3; ++k) sum -= mass(p) * scene_.gravity[k] * x[p][k];
  return sum;
}

// What a projection makes of a constraint: the inertia of its ends over dt².
double Ledger::rigid(std::size_t a, std::size_t b) const {
  const double ma = mass(a), mb = mass(b);
  return (ma > 0 && mb > 0 ? ma * mb / (ma + mb) : ma + mb) / (dt_ * dt_);
}

// Stiffness as the solver feels it.
double Ledger::felt(std::size_t a, std::size_t b, double k) const {
  if (springs_) return k;
  if (scene_.solver.method != weft::Method::positional) return std::min(k, rigid(a, b));
  return rigid(a, b) * std::min(1.0, 2 * cloth_.positional_k * scene_.solver.iterations);
}

// Σ over the constraints of visit(stencil, a, b, stiffness felt).
template <class Visit>
double Ledger::sum_of(Visit&& visit) const {
  double sum = 0;
  for (const weft::physics::Stencil& f : stencils_)
    weft::physics::for_each_constraint(cloth_, f, [&](int a, int b, double k) {
      const auto p = std::size_t(a), q = std::size_t(b);
      sum += visit(f, p, q, felt(p, q, k));
    });
  return sum;
}

// Energy of bending that is felt for sure: (x₀ - 2x₁ + x₂)², projected by itself, is at most as
// stiff as m/6dt². Whole lines feel more of it, up to all.
double Ledger::bent(const std::vector<Vec3>& x) const {
  const double u = spacing_u(cloth_.grid), v = spacing_v(cloth_.grid);
  const double k = cloth_.bending.warp * std::max(u / v / (v * v), v / u / (u * u));
  const double most = mass_of_all() / double(x.size()) / (6 * dt_ * dt_);
  return weft::physics::bending_energy(cloth_, x) * (springs_ || k <= most ? 1 : most / k);
}

double Ledger::elastic(const std::vector<Vec3>& x) const {
  const double limit = 1 + cloth_.strain_limit;
  const bool membrane = springs_ && cloth_.membrane.given();
  const double whole = membrane
                           ? weft::physics::MembraneCells(
                                 cloth_, stencils_, weft::physics::spring_repeats(scene_.solver))
                                 .energy(x)
                           : 0;
  return whole +
         sum_of([&](const weft::physics::Stencil& f, std::size_t a, std::size_t b, double k) {
           if (membrane) k = 0;
           const double length = distance(x[a], x[b]), c = length - f.rest;
           const double over = length - limit * f.rest;
           const bool limited =
               cloth_.strain_limit > 0 && over > 0 && f.kind != weft::physics::Kind::bend;
           return 0.5 * (k * c * c + (limited ? rigid(a, b) * over * over : 0));
         });
}

// What the tethers take back at once.
double Ledger::tethered(const std::vector<Vec3>& x) const {
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
double Ledger::noise(const std::vector<Vec3>& x) const {
  double size = 1;
  for (const Vec3& p : x) size = std::max(size, weft::length(p));
  const double off = kRounding * size;
  std::vector<Vec3> ripples(x.size());
  for (std::size_t p = 0; p < x.size(); ++p) {
    const std::size_t nx = std::size_t(cloth_.grid.nx);
    ripples[p][1] = (p % nx + p / nx) % 2 == 0 ? off : -off;
  }
  return bent(ripples) + sum_of([&](const weft::physics::Stencil&, std::size_t, std::size_t,
                                    double k) { return 0.5 * k * off * off; });
}

}  // namespace bench
