// Energies, forces and strains in double precision (energy.h).
#include "physics/model/lattice/energy.h"

#include <algorithm>
#include <cmath>

#include "physics/model/lattice/bending.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

// The force of a spring along e, and its damping against dv, on both of its ends.
void add_spring(const Stencil& f, double k, const Vec3& e, const Vec3& dv, Vec3& near, Vec3& far) {
  const double length = std::sqrt(dot(e, e));
  if (length == 0) return;
  const double damping = f.damping * (f.stiffness > 0 ? k / f.stiffness : 1);
  const double scale = k * (1 - f.rest / length) + damping * dot(e, dv) / (length * length);
  for (int c = 0; c < 3; ++c) {
    near[c] += scale * e[c];
    far[c] -= scale * e[c];
  }
}

}  // namespace

double elastic_energy(const Cloth& cloth, const std::vector<Stencil>& stencils,
                      const std::vector<Vec3>& x) {
  double energy = 0;
  for (const Stencil& f : stencils)
    for_each_constraint(cloth, f, [&](int a, int b, double k) {
      const Vec3 e = minus(x[b], x[a]);
      const double stretch = length(e) - f.rest;
      energy += 0.5 * k * stretch * stretch;
    });
  return energy;
}

std::vector<Vec3> spring_forces(const Cloth& cloth, const std::vector<Stencil>& stencils,
                                const std::vector<Vec3>& x, const std::vector<Vec3>* v) {
  std::vector<Vec3> force(x.size(), Vec3{});
  for (const Stencil& f : stencils)
    for_each_constraint(cloth, f, [&](int a, int b, double k) {
      const Vec3 dv = v ? minus((*v)[b], (*v)[a]) : Vec3{};
      add_spring(f, k, minus(x[b], x[a]), dv, force[a], force[b]);
    });
  return force;
}

void add_spring_forces(const Cloth& cloth, const std::vector<Stencil>& stencils, const Lattice& l,
                       bool damped, std::vector<Vec3>& a) {
  for (const Stencil& f : stencils)
    for (int j = 0; j + f.dj < l.rows; ++j) {
      const double row = f.stiffness * row_factor(cloth, f, j);
      const float* const factors = column_factors(l, f);
      for (int n = 0; n < f.per_row(l.columns); ++n) {
        if (!f.alive(j, n)) continue;
        const int near = n + f.near(), far = n + f.far();
        const double k = factors ? row * factors[n] : row;
        const auto difference = [&](const Rows& rows) {
          Vec3 d;
          for (int c = 0; c < 3; ++c)
            d[c] = double(rows.at(c, j + f.dj, far)) - rows.at(c, j, near);
          return d;
        };
        add_spring(f, k, difference(l.x), damped ? difference(l.v) : Vec3{},
                   a[std::size_t(j) * l.columns + near],
                   a[std::size_t(j + f.dj) * l.columns + far]);
      }
    }
}

Strain structural_strain(const Cloth& cloth, const std::vector<Stencil>& stencils,
                         const std::vector<Vec3>& x) {
  Strain strain;
  std::int64_t& n = strain.constraints;
  for (const Stencil& f : stencils) {
    if (f.kind != Kind::structural) continue;
    for_each_constraint(cloth, f, [&](int a, int b, double) {
      const Vec3 e = minus(x[b], x[a]);
      const double s = length(e) / f.rest - 1;
      strain.max = n == 0 ? s : std::max(strain.max, s);
      strain.mean += s;
      ++n;
    });
  }
  if (n > 0) strain.mean /= double(n);
  return strain;
}

}  // namespace weft::physics
