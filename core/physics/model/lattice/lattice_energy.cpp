// What is measured of a grid's model in double precision (lattice_model.h).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "physics/model/lattice/bending.h"
#include "physics/model/lattice/energy.h"
#include "physics/model/lattice/lattice_model.h"
#include "physics/model/lattice/stability.h"
#include "physics/model/path.h"
#include "physics/model/segment_distance.h"
#include "physics/model/strain_in_line.h"
#include "physics/step/threads.h"

namespace weft::physics {
namespace {

constexpr double kRounding = 4e-7;  // of positions in single precision, of the scene's size
constexpr double kHalfUnit = 6e-8;  // of their last place, likewise

}  // namespace

const SurfaceMesh& LatticeModel::surface() const {
  const std::uint64_t version = tearing_ ? tearing_->version() : 0;
  if (!surface_.triangles.empty() && surface_.version == version) return surface_;
  if (version == 0) return surface_ = whole_surface();
  const auto number = [&](std::uint32_t lane) {
    return int(lane) / lattice_.stride * lattice_.columns + int(lane) % lattice_.stride;
  };
  surface_.version = version;
  surface_.triangles.clear();
  for (const auto& [a, b, c] : tearing_->triangles())
    surface_.triangles.push_back({number(a), number(b), number(c)});
  return surface_;
}

SurfaceMesh LatticeModel::whole_surface() const {
  SurfaceMesh mesh;
  for (int j = 0; j + 1 < lattice_.rows; ++j)
    for (int i = 0; i + 1 < lattice_.columns; ++i) {
      const int p = lattice_.number(j, i), below = p + lattice_.columns;
      mesh.triangles.push_back({p, p + 1, below});
      mesh.triangles.push_back({p + 1, below + 1, below});
    }
  return mesh;
}

ConstraintCounts LatticeModel::constraints() const {
  ConstraintCounts counts;
  for (const Stencil& f : stencils_) {
    const std::int64_t n = std::int64_t(f.per_row(lattice_.columns)) * (lattice_.rows - f.dj);
    (f.kind == Kind::structural ? counts.structural
     : f.kind == Kind::shear    ? counts.shear
                                : counts.bend) += n;
  }
  return counts;
}

Pull LatticeModel::pull() const {
  Pull pull;
  for (const Stencil& f : stencils_) {
    const double force = 2 * f.stiffness * f.rest;
    pull.stiffness = std::max(pull.stiffness, f.stiffness);
    pull.force = std::max(pull.force, force);
    pull.acceleration += force / lightest_mass(parts_.cloth);
  }
  return pull;
}

MembraneCells LatticeModel::membrane() const {
  return {parts_.cloth, stencils_, spring_repeats(parts_.scene.solver)};
}

void LatticeModel::accelerations(const Vec3& gravity, std::vector<Vec3>& a) const {
  const auto add_stretch = [&](std::vector<Vec3>& force) {
    if (!is_membrane() && !solves_membrane())
      return add_spring_forces(parts_.cloth, stencils_, lattice_,
                               method_ == Method::spring_friction, force);
    const MembraneCells cells = membrane();
    const std::vector<Vec3> v = lattice_.gather(lattice_.v);
    const bool damped = is_membrane() && cells.damping() > 0;
    cells.add_forces(lattice_.gather(lattice_.x), damped ? &v : nullptr, 1, cells.damping(), force);
    const double rate = is_membrane() ? parts_.cloth.bending.damping : 0;
    if (rate > 0)
      add_bending_forces(
          parts_.cloth, [&](int p, int c) { return rate * v[std::size_t(p)][std::size_t(c)]; },
          force, bend_links());
  };
  physics::accelerations(gravity, parts_.cloth, lattice_, bend_links(), add_stretch, a);
}

ElasticEnergy LatticeModel::elastic_energy() const {
  const std::vector<Vec3> x = lattice_.gather(lattice_.x);
  ElasticEnergy energy{.bending = bending_energy(parts_.cloth, x, bend_links())};
  if (is_membrane() || solves_membrane())
    energy.membrane = membrane_energy(lattice_.x);
  else
    energy.springs = physics::elastic_energy(parts_.cloth, stencils_, x);
  return energy;
}

Strain LatticeModel::strain() const {
  return structural_strain(parts_.cloth, stencils_, lattice_.gather(lattice_.x));
}

double LatticeModel::limited_strain() const {
  double most = 0;  // of squared lengths, of those at rest
  for (const Stencil& f : stencils_)
    for (int j = 0; f.kind != Kind::bend && j + f.dj < lattice_.rows; ++j) {
      const FarRows ends = far_rows(f, lattice_.x, lattice_.columns, j);
      most =
          std::max(most, double(parts_.kernels.lattice.greatest_square(ends)) / (f.rest * f.rest));
    }
  return std::sqrt(most) - 1;
}

Vec3 LatticeModel::pin_position(const Pin& pin, double time) const {
  const Vec3 alone = pin_alone_at(parts_.cloth, pin, time);
  return pin.follow < 0 ? alone : followed_.taken_along(pin, alone, time);
}

double LatticeModel::greatest_coordinate(const Rows& x) const {
  return std::max(1.0, double(x.greatest(parts_.kernels)));
}

// 1/s²; of substeps so short that all stiffness is felt.
constexpr float kAtOnce = 1e30f;

// A projected constraint counts as a spring of at most the inertia of its ends over dt², all that a
// sweep makes of it, and of its positional share.
double LatticeModel::stretch_energy(const Rows& x, double dt, Threads& threads) const {
  constexpr std::int64_t kFew = 50000;  // constraints: 60 µs, what it takes to wake a thread
  constexpr std::size_t kParts = 64;
  std::array<double, kParts> sums{};
  const StretchRow r = stretch_row(x, dt);
  const auto first = [&](std::size_t part) {
    return int(part * std::size_t(lattice_.rows) / kParts);
  };
  threads.share(kParts, parts_.constraints() < kFew, [&](std::size_t part) {
    sums[part] = stretch_energy(x, r, {first(part), first(part + 1)});
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

StretchRow LatticeModel::stretch_row(const Rows& x, double dt) const {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const Cloth& cloth = parts_.cloth;
  const double projected = std::min(1.0, 2 * cloth.positional_k * parts_.scene.solver.iterations);
  StretchRow r{};
  r.slack = float(kRounding * greatest_coordinate(x));
  r.share = is_explicit(method_) ? kInfinite : method_ == Method::positional ? float(projected) : 1;
  r.inverse_dt2 = dt > 0 ? float(1 / (dt * dt)) : kAtOnce;
  return r;
}

// Of what joins these rows to themselves and to later ones; `r`: what all rows share.
double LatticeModel::stretch_energy(const Rows& x, StretchRow r, RowSpan rows) const {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const Cloth& cloth = parts_.cloth;
  double sum = 0;
  for (const Stencil& f : stencils_) {
    r.rest = float(f.rest);
    r.give = cloth.strain_limit > 0 && r.inverse_dt2 < kAtOnce ? float(cloth.strain_limit * f.rest)
                                                               : kInfinite;
    for (int j = rows.begin; j < std::min(rows.end, lattice_.rows - f.dj); ++j) {
      static_cast<FarRows&>(r) = far_rows(f, x, lattice_.columns, j);
      r.w_near = lattice_.w(j) + f.near();
      r.w_far = lattice_.w(j + f.dj) + f.far();
      r.stiffness =
          method_ == Method::positional ? kInfinite : float(f.stiffness * row_factor(cloth, f, j));
      r.factor = column_factors(lattice_, f);
      sum += parts_.kernels.lattice.stretch_energy(r);
    }
  }
  return sum;
}

double LatticeModel::membrane_energy(const Rows& x) const {
  return parts_.tearing ? membrane().energy(lattice_.gather(x)) : membrane().energy(x);
}

double LatticeModel::held_energy(const Rows& x, double dt, Threads& threads) const {
  double sum =
      is_membrane() || solves_membrane() ? membrane_energy(x) : stretch_energy(x, dt, threads);
  if (solves_membrane())
    sum += pull().stiffness * double(parts_.constraints()) *
           std::pow(kRounding * greatest_coordinate(x), 2);
  if (parts_.cloth.bending.given()) sum += bending_energy(parts_.cloth, lattice_.gather(x));
  return sum;
}

// Attachments take back at once what is farther from a pin than the sheet is long.
double LatticeModel::attachment_energy(const Rows& x, double dt) const {
  if (!parts_.scene.solver.tethers) return 0;
  const Grid& g = parts_.cloth.grid;
  const Vec3 u = times(g.u, 1.0 / (g.nx - 1)), v = times(g.v, 1.0 / (g.ny - 1));
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
  double sum = 0;
  for (const Pin& pin : parts_.cloth.pins)
    lattice_.for_each([&](int j, int i) {
      const double inverse_mass = lattice_.w(j, i);
      if (inverse_mass <= 0) return;
      const double a = i - pin.i, b = j - pin.j, rest = a * (uu * a + 2 * uv * b) + vv * b * b;
      double squared = 0;
      for (int k = 0; k < 3; ++k) {
        const double e = double(x.at(k, j, i)) - x.at(k, pin.j, pin.i);
        squared += e * e;
      }
      const double over = std::max(0.0, std::sqrt(squared) - std::sqrt(rest));
      sum += 0.5 / inverse_mass * over * over / (dt * dt);
    });
  return sum;
}

double LatticeModel::rounding_gain() const {
  double stiffness = 0;
  for (const Stencil& f : stencils_)
    for_each_constraint(parts_.cloth, f, [&](int, int, double k) { stiffness += k; });
  return stiffness * std::pow(kHalfUnit * greatest_coordinate(lattice_.x), 2);
}

// Every fourth row is looked at.
float LatticeModel::greatest_stretch(const Rows& x) const {
  float most = 0;
  for (const Stencil& f : stencils_) {
    if (f.kind == Kind::bend || (f.kind == Kind::shear && !is_membrane())) continue;
    for (int j = 0; j + f.dj < lattice_.rows; j += 4) {
      const float longest =
          parts_.kernels.lattice.greatest_square(far_rows(f, x, lattice_.columns, j));
      most = std::max(most, longest / float(f.rest * f.rest));
    }
  }
  return most;
}

double LatticeModel::strain_in_line(const Rows& x, double spread) const {
  StrainInLine lines(spread);
  for (const Stencil& f : stencils_) {
    if (f.kind != Kind::structural || f.di + f.dj != 1) continue;
    const auto strain = [&](int j, int a) -> std::optional<double> {
      if (!f.alive(j, a)) return {};
      Vec3 e;
      for (int k = 0; k < 3; ++k)
        e[std::size_t(k)] = double(x.at(k, j + f.dj, a + f.far())) - x.at(k, j, a + f.near());
      return length(e) / f.rest - 1;
    };
    const int columns = f.per_row(lattice_.columns), rows = lattice_.rows - f.dj;
    if (f.di == 1)
      for (int j = 0; j < rows; ++j) lines.look(columns, [&](int n) { return strain(j, n); });
    else
      for (int i = 0; i < columns; ++i) lines.look(rows, [&](int n) { return strain(n, i); });
  }
  return lines.greatest();
}

Spectrum LatticeModel::find_spectrum(std::span<const float> inverse_masses) const {
  Lattice start = make_lattice(parts_.cloth, index_, seed_, false);
  std::copy(inverse_masses.begin(), inverse_masses.end(), start.inverse_mass.data());
  if (is_membrane()) return membrane_spectrum(parts_.cloth, membrane(), start);
  return estimate_spectrum(parts_.cloth, stencils_, start, method_ == Method::spring_friction,
                           parts_.kernels);
}

double LatticeModel::stiffening(double stretch) const {
  return is_membrane() ? stiffening_of_membrane(stretch) : stiffening_of_springs(stretch);
}

bool LatticeModel::folds_freely() const {
  const auto has = [&](Kind kind) {
    return std::any_of(stencils_.begin(), stencils_.end(),
                       [&](const Stencil& f) { return f.kind == kind; });
  };
  return !has(Kind::structural) || !has(Kind::shear);
}

std::vector<Joined> LatticeModel::constraints_near(const Vec3& a, const Vec3& way,
                                                   double distance) const {
  std::vector<Joined> found;
  for (const Stencil& f : stencils_)
    for (int j = 0; j + f.dj < lattice_.rows; ++j)
      for (int k = 0; k < f.per_row(lattice_.columns); ++k) {
        const int near = k + f.near(), far = k + f.far();
        const Vec3 from = lattice_.position(j, near);
        if (f.alive(j, k) &&
            segment_distance(a, way, from, minus(lattice_.position(j + f.dj, far), from)) <=
                distance)
          found.push_back({lattice_.number(j, near), lattice_.number(j + f.dj, far)});
      }
  return found;
}

}  // namespace weft::physics
