// Stable settings of methods that project (projection_substep.h).
#include "physics/frame/projection_substep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "physics/model/cloth_model.h"
#include "physics/model/lattice/stability.h"
#include "physics/model/lattice/stencil.h"
#include "physics/model/mesh/gas.h"
#include "physics/model/path.h"
#include "physics/model/push.h"
#include "weft/mesh.h"

namespace weft::physics {
namespace {

constexpr double kJacobi = 0.3;     // of what a Gauss-Seidel sweep does: it takes means
constexpr double kAlikeMasses = 4;  // greatest over least that Jacobi takes

// As many Gauss-Seidel sweeps do as much in a substep.
double sweeps_of(const Solver& solver) {
  return solver.iterations * (solver.sweep == Sweep::jacobi ? kJacobi : 1);
}

// What the substep of methods that project depends on.
struct Fineness {
  double points_over_spacing;  // 1/m; along the longer side
  double mass, stiffness;      // kg, N/m
  double spacing, particles;   // m, of the closer ones; how many
};

// m²; of a mesh, as its file has it.
double area_of(const TriangleMesh& mesh) {
  const std::vector<Vec3>& x = mesh.vertices;
  double twice = 0;
  for (const auto& [p, q, r] : mesh.triangles)
    twice += length(normal_of(x[std::size_t(p)], x[std::size_t(q)], x[std::size_t(r)]));
  return twice / 2;
}

Fineness fineness_of(const Cloth& c, const Solver& solver) {
  if (!c.mesh.given())
    return {std::max(c.grid.nx / spacing_u(c.grid), c.grid.ny / spacing_v(c.grid)),
            lightest_mass(c), spring_repeats(solver) * greatest_stiffness(c),
            std::min(spacing_u(c.grid), spacing_v(c.grid)), double(c.grid.nx) * c.grid.ny};
  // As if its triangles were halves of squares of their mean area.
  const std::vector<Vec3>& x = c.mesh.shape->vertices;
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax_element(
        x.begin(), x.end(), [&](const Vec3& a, const Vec3& b) { return a[k] < b[k]; });
    longest = std::max(longest, (*high)[k] - (*low)[k]);
  }
  const double scale = c.mesh.scale;
  const double square =
      scale * scale * 2 * area_of(*c.mesh.shape) / double(c.mesh.shape->triangles.size());
  const Membrane& m = c.membrane;
  const double stiffness = m.given() ? std::max({m.warp, m.weft, m.shear}) : c.stiffness.structural;
  return {scale * longest / square, c.density * square, stiffness, std::sqrt(square),
          double(x.size())};
}

constexpr double kOverstretch = 0.7, kGrows = 0.8;  // of overstretch()

// m/s²; by which a gas accelerates the cloth that holds it at the start, where its pressure is greatest.
double push_of_gas(const Cloth& c) {
  if (!c.pressure.given()) return 0;
  const GasLaw law(c.pressure, 1);
  return std::abs(law.over(law.greatest_share(), 1)) / c.density;
}

// 1/s²; a/dt² of gas_shortfall(), with the gas as it starts, at its most.
double softening_of_gas(const Cloth& c) {
  if (c.pressure.inflate == 0) return 0;
  const double volume = std::abs(enclosed_volume(c));
  const GasLaw law(c.pressure, volume);
  const double area = c.mesh.scale * c.mesh.scale * area_of(*c.mesh.shape);
  return law.stiffness(law.greatest_share(), volume) * area / c.density;
}

// What k dt² may be for each sweep, of m, if sheets drawn out between two sides are to tear at 0.8 to 1.2 of the
// converged stretch. A Jacobi sweep makes all constraints about as stiff, so that less strain gathers at corners: 1.15
// here, 1.3 with six times as much. Membranes of few sweeps shear less than they should: 0.81 here, 0.66 with four
// times as much. Line sweeps are within 0.93 and 1.14 here, and with four times as much they shake the sheet, to 0.36.
double spread_by(const Cloth& cloth, Sweep sweep) {
  if (sweep == Sweep::jacobi) return 0.25;
  if (sweep == Sweep::line) return 4;
  return cloth.membrane.given() ? 1 : std::numeric_limits<double>::infinity();
}

}  // namespace

double projection_substep(const Scene& scene) {
  constexpr double kSag = 0.02;
  constexpr double kLines = 10;  // the same, against a gas; 15 on balls of 270 vertices
  constexpr double kGas = 0.1;   // k dt²/m; strain and energy within a twentieth
  constexpr double kMoved =
      0.15;  // spacings, that the load of a pin may move a particle by in a substep
  const Solver& solver = scene.solver;
  const bool lines = solver.sweep == Sweep::line;
  const double g = solver.tethers ? 0 : greatest_gravity(scene);
  const double sweeps = sweeps_of(solver);
  double dt = kLongestProjection;
  for (const Cloth& c : scene.cloths) {
    const Fineness f = fineness_of(c, solver);
    const double gas = push_of_gas(c);
    const auto hold = [&](double needed) {
      // Or what the material asks for by itself.
      const double share = gas > 0 && !lines ? kGas : 1;
      if (solver.method != Method::positional)
        needed = std::max(needed, std::sqrt(share * f.mass / std::max(f.stiffness, 1e-12)));
      dt = std::min(dt, needed);
    };
    const double pull = (lines ? 0 : g) + gas / (lines ? kLines : 1);
    if (pull > 0) hold(std::sqrt(kSag * sweeps / (2 * pull * f.points_over_spacing)));
    const auto pins = double(single_pins(c).size());
    if (lines && g > 0 && pins > 0)
      hold(std::sqrt(kMoved * sweeps * f.spacing * pins / (g * f.particles)) /
           implicit_share(solver));
  }
  return dt;
}

double overstretch(const Scene& scene, const Cloth& cloth, Method method, double dt) {
  const Solver& solver = scene.solver;
  if (method != Method::compliant || solver.sweep == Sweep::line || solver.tethers ||
      (cloth.pins.empty() && !cloth.pressure.given()))
    return 1;
  const Fineness f = fineness_of(cloth, solver);
  const double h = dt * implicit_share(solver);
  return 1 + kOverstretch * std::pow(f.stiffness * h * h / (f.mass * sweeps_of(solver)), kGrows);
}

double substep_of_overstretch(const Scene& scene, const Cloth& cloth, double times) {
  const Fineness f = fineness_of(cloth, scene.solver);
  const double q = std::pow((times - 1) / kOverstretch, 1 / kGrows);
  return std::sqrt(q * f.mass * sweeps_of(scene.solver) / f.stiffness) /
         implicit_share(scene.solver);
}

double gas_shortfall(const Cloth& cloth, double dt) {
  const double a = dt * dt * softening_of_gas(cloth);
  return a / (1 + a);
}

double substep_of_shortfall(const Cloth& cloth, double shortfall) {
  return std::sqrt(shortfall / (1 - shortfall) / softening_of_gas(cloth));
}

double tearing_substep(const Scene& scene, const Cloth& cloth, Method method) {
  const Solver& solver = scene.solver;
  // The membrane of a mesh that tears has no strands.
  const bool triangles = cloth.mesh.given() && cloth.membrane.given();
  const double share = spread_by(cloth, triangles ? Sweep::gauss_seidel : solver.sweep);
  if (cloth.tear_strain == 0 || is_explicit(method) || cloth.tears == Tears::particles ||
      std::isinf(share))
    return std::numeric_limits<double>::infinity();
  if (method == Method::positional) return 0;
  const Fineness f = fineness_of(cloth, solver);
  return std::sqrt(share * sweeps_of(solver) * f.mass / std::max(f.stiffness, 1e-12));
}

Shaking shaking(const Scene& scene, const Cloth& cloth, Method method, double dt) {
  // Grids of 17 to 100 points, hung by corners, drawn out and with tethers, 2 to 64 substeps of 1 and 2 sweeps: below
  // 1.9 strain is as in finer substeps, from 2.5 on several times as great. Meshes of 17 x 17, drawn out: below 0.65
  // they rest, from 0.9 on they shake; at a vertex three strands cross.
  const double shakes = cloth.mesh.given() ? 0.7 : 2;
  const Solver& solver = scene.solver;
  if (method != Method::compliant || solver.sweep != Sweep::line)
    return {std::numeric_limits<double>::infinity(), 0};
  const Membrane& m = cloth.membrane;
  const double stiffness =
      m.given() ? std::max(m.warp, m.weft) : spring_repeats(solver) * cloth.stiffness.structural;
  const double h = dt * implicit_share(solver);
  const double pull = stiffness * h * h / fineness_of(cloth, solver).mass;
  return {shakes * solver.iterations / std::max(pull, 1e-300), std::sqrt(pull)};
}

std::string steady_jacobi(Scene& scene) {
  if (scene.solver.sweep != Sweep::jacobi) return "";
  const double dt = scene.time.substeps == kAutoSubsteps ? projection_substep(scene)
                                                         : scene.time.frame / scene.time.substeps;
  bool stiff = false;
  for (const Cloth& c : scene.cloths) {
    const double lightest = lightest_mass(c);
    double heaviest = lightest;
    for (const double mass : c.masses) heaviest = std::max(heaviest, mass);
    if (heaviest > kAlikeMasses * lightest) {
      scene.solver.sweep = Sweep::gauss_seidel;
      return "Jacobi sweeps do not converge for masses this unequal; gauss_seidel runs in their "
             "place";
    }
    stiff |= 2 * greatest_stiffness(c) * dt * dt > lightest;
  }
  if (!stiff || scene.solver.method != Method::compliant || scene.solver.iterations > 1) return "";
  scene.solver.iterations = 2;
  return "one Jacobi sweep of constraints this stiff is not stable in large motions; two run";
}

}  // namespace weft::physics
