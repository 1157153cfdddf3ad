// Constraint stencils of a cloth (stencil.h).
#include "physics/model/lattice/stencil.h"

#include <algorithm>
#include <cmath>

namespace weft::physics {
namespace {

double rest_length(const Grid& g, int di, int dj) {
  double squared = 0;
  for (int k = 0; k < 3; ++k) {
    const double e = g.u[k] / (g.nx - 1) * di + g.v[k] / (g.ny - 1) * dj;
    squared += e * e;
  }
  return std::sqrt(squared);
}

}  // namespace

double spring_repeats(const Solver& solver) {
  const bool springs = solver.method == Method::spring || solver.method == Method::spring_friction;
  return springs && solver.iterate_springs ? solver.iterations : 1;
}

std::vector<Stencil> stencils_of(const Cloth& cloth, const Solver& solver) {
  std::vector<Stencil> stencils;
  const Grid& g = cloth.grid;
  const double repeats = spring_repeats(solver);
  const auto add = [&](int di, int dj, Kind kind, double stiffness, double damping) {
    if (stiffness <= 0 || std::abs(di) >= g.nx || dj >= g.ny) return;
    stencils.push_back(
        {di, dj, kind, rest_length(g, di, dj), repeats * stiffness, repeats * damping});
  };
  if (cloth.membrane.given()) {
    const Membrane& m = cloth.membrane;
    add(1, 0, Kind::structural, m.warp - m.shear, 0);
    add(0, 1, Kind::structural, m.weft - m.shear, 0);
    add(1, 1, Kind::shear, m.shear, 0);
    add(-1, 1, Kind::shear, m.shear, 0);
    return stencils;
  }
  const Kinds &k = cloth.stiffness, &d = cloth.spring_damping;
  if (cloth.level == 0) {
    add(1, 0, Kind::structural, k.structural, d.structural);
    add(0, 1, Kind::structural, k.structural, d.structural);
    add(1, 1, Kind::shear, k.shear, d.shear);
    add(-1, 1, Kind::shear, k.shear, d.shear);
    add(2, 0, Kind::bend, k.bend, d.bend);
    add(0, 2, Kind::bend, k.bend, d.bend);
  }
  for (int n = 1; n <= cloth.level; ++n) {
    const Kind axis = n == 1 ? Kind::structural : Kind::bend;
    const Kind diagonal = n == 1 ? Kind::shear : Kind::bend;
    add(n, 0, axis, k.structural, d.structural);
    add(0, n, axis, k.structural, d.structural);
    add(n, n, diagonal, k.structural, d.structural);
    if (cloth.level_diagonals == LevelDiagonals::both)
      add(-n, n, diagonal, k.structural, d.structural);
  }
  return stencils;
}

double greatest_stiffness(const Cloth& cloth) {
  const Kinds& k = cloth.stiffness;
  return cloth.membrane.given() ? std::max(cloth.membrane.warp, cloth.membrane.weft)
                                : std::max({k.structural, k.shear, k.bend});
}

Links::Links(int rows, int stride, int per_row)
    : stride_(static_cast<std::size_t>(stride)),
      lanes_(2 * kGuard + static_cast<std::size_t>(rows) * stride_) {
  for (int j = 0; j < rows; ++j) std::fill_n(row(j), per_row, -1);
}

double row_factor(const Cloth& cloth, const Stencil& f, int j) {
  const double gradient = 1 - cloth.stiffness_gradient * (j + 0.5 * f.dj) / (cloth.grid.ny - 1);
  return f.dj == 0 ? gradient * width_share(cloth, 0, j, f.di, 0) : gradient;
}

const float* column_factors(const Lattice& l, const Stencil& f) {
  return f.di == 0 ? l.column_width.data() : nullptr;
}

FarRows far_rows(const Stencil& f, const Rows& x, int columns, int j) {
  return {f.per_row(columns), x.row(j).from(f.near()), x.row(j + f.dj).from(f.far()),
          f.links ? f.links->row(j) : nullptr};
}

StencilRow stencil_row(Lattice& l, const Stencil& f, int j) {
  StencilRow r{};
  r.count = f.per_row(l.columns);
  r.near = f.near();
  r.far = f.far();
  r.same_row = f.dj == 0;
  r.x = l.x.row(j);
  r.x_far = l.x.row(j + f.dj);
  r.v = l.v.row(j);
  r.v_far = l.v.row(j + f.dj);
  r.w = l.w(j);
  r.w_far = l.w(j + f.dj);
  r.factor = column_factors(l, f);
  if (f.links) r.alive = f.links->row(j);
  return r;
}

SpringConstants spring_constants(const Cloth& cloth, const Stencil& f, int j) {
  if (j + f.dj >= cloth.grid.ny) return {};
  const double factor = row_factor(cloth, f, j), k = f.stiffness * factor;
  return {float(k), float(k * f.rest), float(f.damping * factor)};
}

}  // namespace weft::physics
