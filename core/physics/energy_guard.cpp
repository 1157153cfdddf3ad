// Counts energies (energy_guard.h). Sums run over the particles in their order, in double.
#include "physics/energy_guard.h"

#include <algorithm>
#include <cmath>

#include "physics/bending.h"
#include "physics/colliders/shapes.h"
#include "physics/energy.h"
#include "physics/path.h"

namespace weft::physics {
namespace {

using Cloths = std::vector<std::unique_ptr<ClothStep>>;

constexpr double kRounding = 4e-7;   // of positions in single precision, of the scene's size
constexpr double kHalfUnit = 6e-8;   // of their last place, likewise
constexpr double kStillness = 0.01;  // m/s; motion that is never looked into
constexpr double kDrivenSpeed = 10;  // m/s; what wind, paths and hands may give besides their own

// Visits all free particles: row, column, mass.
template <class Visit>
void for_each_free(const Lattice& l, Visit&& visit) {
  for (int j = 0; j < l.rows; ++j)
    for (int i = 0; i < l.columns; ++i)
      if (const double w = l.w(j, i); w > 0) visit(j, i, 1 / w);
}

// Where colliders will have put what lies inside them.
void push_out(const Scene& scene, double time, const Lattice& l, std::vector<Vec3>& x) {
  for (const Collider& c : scene.colliders) {
    if (c.cuts) continue;
    const Vec3 moved = displacement(c, time);
    for_each_free(l, [&](int j, int i, double) {
      Vec3& p = x[std::size_t(j) * l.columns + i];
      std::visit(
          [&](const auto& shape) {
            const Nearest n = nearest_of(shape, minus(minus(p, moved), place_of(shape)));
            if (n.distance < c.offset) p = plus(p, times(n.normal, c.offset - n.distance));
          },
          c.shape);
    });
  }
}

// Elastic energy as the method feels it, with what rounding of the positions puts in at once, and
// what rounding them anew in every substep adds.
struct Elastic {
  double energy = 0;       // J
  double per_substep = 0;  // J
};
Elastic elastic(const Scene& scene, Method method, const ClothStep& step,
                const std::vector<Vec3>& x, double dt) {
  const Lattice& l = step.lattice();
  double size = 1, stiffness = 0;
  for (const Vec3& p : x) size = std::max(size, std::sqrt(dot(p, p)));
  const double share =
      std::min(1.0, 2 * step.cloth().positional_k * scene.solver.iterations);  // of positional
  const auto inverse_mass = [&](int p) { return double(l.w(p / l.columns, p % l.columns)); };
  double sum = bending_energy(step.cloth(), x);
  for (const Family& f : step.families())
    for_each_constraint(step.cloth(), f, [&](int a, int b, double k) {
      const double w = inverse_mass(a) + inverse_mass(b);
      const double rigid = w > 0 ? 1 / (w * dt * dt) : 0;
      if (method == Method::positional) k = rigid * share;
      if (method == Method::compliant) k = std::min(k, rigid);
      const Vec3 e = minus(x[std::size_t(b)], x[std::size_t(a)]);
      const double c = std::abs(std::sqrt(dot(e, e)) - f.rest) + kRounding * size;
      sum += 0.5 * k * c * c;
      stiffness += k;
      const double over = c - step.cloth().strain_limit * f.rest;
      if (step.cloth().strain_limit > 0 && over > 0) sum += 0.5 * rigid * over * over;
    });
  // Tethers take back at once what is farther from a pin than the sheet is long.
  const Grid& g = step.cloth().grid;
  for (std::size_t n = 0; scene.solver.tethers && n < step.cloth().pins.size(); ++n) {
    const Pin& pin = step.cloth().pins[n];
    for_each_free(l, [&](int j, int i, double mass) {
      Vec3 rest;
      for (int k = 0; k < 3; ++k)
        rest[k] = g.u[k] / (g.nx - 1) * (i - pin.i) + g.v[k] / (g.ny - 1) * (j - pin.j);
      const Vec3 e =
          minus(x[std::size_t(j) * l.columns + i], x[std::size_t(pin.j) * l.columns + pin.i]);
      const double over = std::max(0.0, std::sqrt(dot(e, e)) - std::sqrt(dot(rest, rest)));
      sum += 0.5 * mass * over * over / (dt * dt);
    });
  }
  return {sum, stiffness * std::pow(kHalfUnit * size, 2)};
}

}  // namespace

Holding holding_of(const Scene& scene, Method method, const ClothStep& step, const Rows& x,
                   const Rows& v, double dt) {
  const Lattice& l = step.lattice();
  Holding h;
  h.inner = elastic(scene, method, step, gather(l, x), dt).energy;
  for_each_free(l, [&](int j, int i, double m) {
    for (int k = 0; k < 3; ++k) {
      h.inner += 0.5 * m * double(v.at(k, j, i)) * v.at(k, j, i);
      h.height -= m * scene.gravity[k] * x.at(k, j, i);
    }
  });
  return h;
}

double fastest_drive(const Scene& scene) {
  const auto fastest = [](const std::vector<Key>& keys) {
    double most = 0;
    for (std::size_t n = 1; n < keys.size(); ++n) {
      const Vec3 e = minus(keys[n].position, keys[n - 1].position);
      most = std::max(most, std::sqrt(dot(e, e)) / (keys[n].time - keys[n - 1].time));
    }
    return most;
  };
  double most = std::sqrt(dot(scene.wind.velocity, scene.wind.velocity));
  for (const Collider& c : scene.colliders) most = std::max(most, fastest(c.keys));
  for (const Cloth& c : scene.cloths)
    for (const Pin& p : c.pins) most = std::max(most, fastest(p.keys));
  return most;
}

void EnergyGuard::open(const Scene& scene, Method method, const Cloths& cloths, double time,
                       double dt) {
  *this = {};
  double mass = 0;
  for (const auto& step : cloths) {
    const Lattice& l = step->lattice();
    for_each_free(l, [&](int, int, double m) { mass += m; });
    std::vector<Vec3> x = gather(l, l.x);
    const Elastic as_set = elastic(scene, method, *step, x, dt);
    push_out(scene, time, l, x);
    put_in_ += std::max(as_set.energy, elastic(scene, method, *step, x, dt).energy);
    if (is_explicit(method)) rounding_ += as_set.per_substep;  // projection loses what it gains
  }
  look(scene, cloths, false);
  highest_ = potential_;
  fall_ = 0;
  const double driven = kDrivenSpeed + fastest_drive(scene);
  put_in_ += kinetic_ + 0.5 * mass * kStillness * kStillness;
  driven_floor_ = 0.5 * mass * driven * driven;
}

void EnergyGuard::look(const Scene& scene, const Cloths& cloths, bool driven) {
  driven_ = driven;
  kinetic_ = potential_ = 0;
  for (const auto& step : cloths) {
    const Lattice& l = step->lattice();
    EnergyRow r{};
    r.columns = l.columns;
    for (int k = 0; k < 3; ++k) r.g[k] = scene.gravity[k];
    for (int j = 0; j < l.rows; ++j) {
      r.x = l.x.row(j);
      r.v = l.v.row(j);
      r.w = l.w(j);
      const RowEnergy e = step->parts().kernels.row_energy(r);
      kinetic_ += e.kinetic;
      potential_ += e.potential;
    }
  }
  fall_ = std::max(released_, highest_ - potential_);
}

void EnergyGuard::accept(int substeps) {
  highest_ = std::max(highest_, potential_);
  released_ = fall_;
  put_in_ += substeps * rounding_;
}

double EnergyGuard::reduction() const {
  return std::sqrt(bound() / kinetic_);
}

double EnergyGuard::bound() const {
  const double kept = put_in_ + fall_;
  return kBound * (driven_ ? std::max(kept, driven_floor_) : kept);
}

}  // namespace weft::physics
