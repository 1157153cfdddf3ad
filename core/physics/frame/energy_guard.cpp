// Counts energies (energy_guard.h). Sums run over the particles in their order, in double.
#include "physics/frame/energy_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/contact/colliders/shapes.h"
#include "physics/model/lattice/bending.h"
#include "physics/model/lattice/energy.h"
#include "physics/model/path.h"

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

// Positions outside of the colliders, where these will have put what lies inside them.
Rows pushed_out(const Scene& scene, double time, const Lattice& l) {
  Rows x(l.rows, l.stride);
  x.copy(l.x);
  for (const Collider& c : scene.colliders) {
    if (c.cuts) continue;
    const Vec3 moved = displacement(c, time);
    for_each_free(l, [&](int j, int i, double) {
      const Vec3 p{x.at(0, j, i), x.at(1, j, i), x.at(2, j, i)};
      std::visit(
          [&](const auto& shape) {
            const Nearest n = nearest_of(shape, minus(minus(p, moved), place_of(shape)));
            for (int k = 0; k < 3 && n.distance < c.offset; ++k)
              x.at(k, j, i) = coordinate(p[k] + (c.offset - n.distance) * n.normal[k]);
          },
          c.shape);
    });
  }
  return x;
}

double greatest_coordinate(const ClothStep& step, const Rows& x) {
  return std::max(1.0, double(x.greatest(step.parts().kernels)));
}

// What constraints hold as the method feels them, with what rounding of the positions puts in at once.
double stretch_energy(const Scene& scene, Method method, const ClothStep& step, const Rows& x,
                      double dt) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const Lattice& l = step.lattice();
  const Cloth& cloth = step.cloth();
  const double projected = std::min(1.0, 2 * cloth.positional_k * scene.solver.iterations);
  StretchRow r{};
  r.slack = float(kRounding * greatest_coordinate(step, x));
  r.share = is_explicit(method) ? kInfinite : method == Method::positional ? float(projected) : 1;
  r.inverse_dt2 = float(1 / (dt * dt));
  double sum = 0;
  for (const Stencil& f : step.stencils()) {
    r.rest = float(f.rest);
    r.give = cloth.strain_limit > 0 ? float(cloth.strain_limit * f.rest) : kInfinite;
    for (int j = 0; j + f.dj < l.rows; ++j) {
      static_cast<FarRows&>(r) = far_rows(f, x, l.columns, j);
      r.w_near = l.w(j) + f.near();
      r.w_far = l.w(j + f.dj) + f.far();
      r.stiffness = method == Method::positional
                        ? kInfinite
                        : float(f.stiffness * gradient_factor(cloth, j, f.dj));
      sum += step.parts().kernels.stretch_energy(r);
    }
  }
  return sum;
}

// Tethers take back at once what is farther from a pin than the sheet is long.
double tether_energy(const ClothStep& step, const Rows& x, double dt) {
  const Lattice& l = step.lattice();
  const Grid& g = step.cloth().grid;
  const Vec3 u = times(g.u, 1.0 / (g.nx - 1)), v = times(g.v, 1.0 / (g.ny - 1));
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
  double sum = 0;
  for (const Pin& pin : step.cloth().pins)
    for_each_free(l, [&](int j, int i, double mass) {
      const double a = i - pin.i, b = j - pin.j, rest = a * (uu * a + 2 * uv * b) + vv * b * b;
      double squared = 0;
      for (int k = 0; k < 3; ++k) {
        const double e = double(x.at(k, j, i)) - x.at(k, pin.j, pin.i);
        squared += e * e;
      }
      const double over = std::max(0.0, std::sqrt(squared) - std::sqrt(rest));
      sum += 0.5 * mass * over * over / (dt * dt);
    });
  return sum;
}

double elastic(const Scene& scene, Method method, const ClothStep& step, const Rows& x, double dt) {
  double sum = stretch_energy(scene, method, step, x, dt);
  if (step.cloth().bending > 0) sum += bending_energy(step.cloth(), gather(step.lattice(), x));
  return sum;
}

// What springs gain in a substep by positions that are rounded anew [J].
double rounding_gain(const ClothStep& step) {
  double stiffness = 0;
  for (const Stencil& f : step.stencils())
    for_each_constraint(step.cloth(), f, [&](int, int, double k) { stiffness += k; });
  return stiffness * std::pow(kHalfUnit * greatest_coordinate(step, step.lattice().x), 2);
}

EnergySum motion(const Scene& scene, const ClothStep& step, const Rows& x, const Rows& v) {
  const Lattice& l = step.lattice();
  EnergySum sum;
  for (int j = 0; j < l.rows; ++j)
    sum += step.parts().kernels.energy_sum(energy_row(l, x.row(j), v.row(j), j, scene.gravity));
  return sum;
}

double free_mass(const Lattice& l) {
  double mass = 0;
  for_each_free(l, [&](int, int, double m) { mass += m; });
  return mass;
}

// The greatest speed of paths between two times, and of wind [m/s].
double fastest_drive(const Scene& scene, double from, double to) {
  const auto fastest = [&](const std::vector<Key>& keys) {
    double most = 0;
    for (std::size_t n = 1; n < keys.size(); ++n) {
      if (keys[n].time <= from || keys[n - 1].time >= to) continue;
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

}  // namespace

bool gained(const Scene& scene, Method method, const ClothStep& step, const Rows& x, const Rows& v,
            double dt, double start, double end) {
  constexpr double kMore = 2;
  const Lattice& l = step.lattice();
  const EnergySum before = motion(scene, step, x, v), now = motion(scene, step, l.x, l.v);
  double put_in = std::max(0.0, before.potential - now.potential);
  if (const double speed = kMore * fastest_drive(scene, start, end); speed > 0)
    put_in += 0.5 * free_mass(l) * speed * speed;
  const double inner = now.kinetic + elastic(scene, method, step, l.x, dt);
  // EnergySum alone accounts for most frames.
  if (inner <= kMore * before.kinetic + put_in) return false;
  return inner > kMore * (before.kinetic + elastic(scene, method, step, x, dt)) + put_in;
}

Balance balance(const Scene& scene, Method method, const ClothStep& step, double dt) {
  const Lattice& l = step.lattice();
  const EnergySum now = motion(scene, step, l.x, l.v);
  return {now.kinetic + elastic(scene, method, step, l.x, dt), now.potential,
          2 * step.cloth().drag * now.kinetic * scene.time.frame};
}

bool works(const Scene& scene, double from, double to) {
  return fastest_drive(scene, from, to) > 0;
}

bool Upkeep::kept_up(const Balance& now) {
  constexpr double kMore = 2;
  const double all = now.inner + now.potential;
  if (!known_ || all < least_) {
    known_ = true;
    least_ = all;
    inner_ = now.inner;
    lost_ = 0;
    return false;
  }
  lost_ += now.lost;
  return lost_ > kMore * inner_;
}

void EnergyGuard::open(const Scene& scene, Method method, const Cloths& cloths, double time,
                       double dt) {
  *this = {};
  for (const auto& step : cloths) {
    const Lattice& l = step->lattice();
    free_mass_ += free_mass(l);
    const auto held = [&](const Rows& x) {
      const double tethers = scene.solver.tethers ? tether_energy(*step, x, dt) : 0;
      return elastic(scene, method, *step, x, dt) + tethers;
    };
    put_in_ += std::max(held(l.x), held(pushed_out(scene, time, l)));
    if (is_explicit(method)) rounding_ += rounding_gain(*step);  // projection loses what it gains
  }
  look(scene, cloths, false);
  highest_ = potential_;
  fall_ = 0;
  put_in_ += kinetic_ + 0.5 * free_mass_ * kStillness * kStillness;
  fastest_ = fastest_drive(scene, 0, std::numeric_limits<double>::infinity());
}

void EnergyGuard::drive(double speed) {
  fastest_ = std::max(fastest_, speed);
}

void EnergyGuard::look(const Scene& scene, const Cloths& cloths, bool driven) {
  EnergySum all;
  for (const auto& step : cloths) all += motion(scene, *step, step->lattice().x, step->lattice().v);
  look(all, driven);
}

void EnergyGuard::look(const EnergySum& all, bool driven) {
  driven_ = driven;
  kinetic_ = all.kinetic;
  potential_ = all.potential;
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
  const double kept = put_in_ + fall_, speed = kDrivenSpeed + fastest_;
  return kBound * (driven_ ? std::max(kept, 0.5 * free_mass_ * speed * speed) : kept);
}

}  // namespace weft::physics
