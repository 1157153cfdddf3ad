// The membrane energy in double precision (membrane.h).
#include "physics/model/lattice/membrane.h"

#include <cassert>
#include <utility>

#include "weft/vec3.h"

namespace weft::physics {
namespace {

enum Member { kRight, kDown, kDiagonal, kAntidiagonal };  // the order of stencils_of

Vec3 edge(const std::vector<Vec3>& x, int from, int to) {
  return minus(x[std::size_t(to)], x[std::size_t(from)]);
}

// Adds `pull` times the edge to the force on its start, and takes it off that on its end.
void add_pull(const std::vector<Vec3>& x, int from, int to, double pull, std::vector<Vec3>& force) {
  const Vec3 f = times(edge(x, from, to), pull);
  force[std::size_t(from)] = plus(force[std::size_t(from)], f);
  force[std::size_t(to)] = minus(force[std::size_t(to)], f);
}

}  // namespace

// Corners: 0 (i, j), 1 (i+1, j), 2 (i, j+1), 3 (i+1, j+1).
struct MembraneCells::Cell {
  int corner[4];
  bool along[2], across[2];  // its edges that are there: of row j and j+1, of column i and i+1
  bool sheared, whole;
  double weight;  // m², of area, with the share of its row

  struct Strain {
    double along[2], across[2], shear;
    double mean_along() const { return (along[0] + along[1]) / 2; }
    double mean_across() const { return (across[0] + across[1]) / 2; }
  };
  // Of e(one, other) = (one·other/h² - rest)/2: Green's strain, or how fast it changes.
  Strain strain(const std::vector<Vec3>& x, const std::vector<Vec3>& y, double hu, double hv,
                double rest, double scale) const {
    const auto of = [&](int from, int to, double h) {
      const double square =
          dot(edge(x, corner[from], corner[to]), edge(y, corner[from], corner[to]));
      return scale * (square / (h * h) - rest) / 2;
    };
    const auto product = [&](int from, int to) {
      return dot(edge(x, corner[from], corner[to]), edge(y, corner[from], corner[to]));
    };
    return {{of(0, 1, hu), of(2, 3, hu)},
            {of(0, 2, hv), of(1, 3, hv)},
            scale * (product(0, 3) - product(2, 1)) / (4 * hu * hv)};
  }
};

MembraneCells::MembraneCells(const Cloth& cloth, const std::vector<Stencil>& stencils,
                             double repeats)
    : membrane_(cloth.membrane),
      stencils_(stencils),
      columns_(cloth.grid.nx),
      rows_(cloth.grid.ny),
      hu_(spacing_u(cloth.grid)),
      hv_(spacing_v(cloth.grid)),
      gradient_(cloth.stiffness_gradient) {
  for (double* modulus : {&membrane_.warp, &membrane_.weft, &membrane_.coupling, &membrane_.shear})
    *modulus *= repeats;
}

double MembraneCells::factor(int j) const {
  return j >= 0 && j + 1 < rows_ ? 1 - gradient_ * (j + 0.5) / (rows_ - 1) : 0;
}

MembraneConstants MembraneCells::constants(int j) const {
  const double f = factor(j), area = hu_ * hv_, per_u = area / (hu_ * hu_),
               per_v = area / (hv_ * hv_);
  return {float(per_u * membrane_.warp * (factor(j - 1) + f) / 2),
          float(per_v * membrane_.weft * f), float(per_u * membrane_.coupling * f / 4),
          float(per_v * membrane_.coupling * f / 4), float(membrane_.shear * f / (8 * area))};
}

MembraneCells::Cell MembraneCells::cell(int i, int j) const {
  const auto there = [&](Member m, int row, int a) {
    return stencils_[std::size_t(m)].alive(row, a);
  };
  const int p = j * columns_ + i;
  Cell c{{p, p + 1, p + columns_, p + columns_ + 1},
         {there(kRight, j, i), there(kRight, j + 1, i)},
         {there(kDown, j, i), there(kDown, j, i + 1)},
         there(kDiagonal, j, i) && there(kAntidiagonal, j, i),
         false,
         hu_ * hv_ * factor(j)};
  c.whole = c.sheared && c.along[0] && c.along[1] && c.across[0] && c.across[1];
  return c;
}

double MembraneCells::energy(const std::vector<Vec3>& x) const {
  double energy = 0;
  const Membrane& m = membrane_;
  for (int j = 0; j + 1 < rows_; ++j)
    for (int i = 0; i + 1 < columns_; ++i) {
      const Cell c = cell(i, j);
      const Cell::Strain e = c.strain(x, x, hu_, hv_, 1, 1);
      double sum = c.sheared ? m.shear * e.shear * e.shear / 2 : 0;
      for (int side = 0; side < 2; ++side) {
        if (c.along[side]) sum += m.warp * e.along[side] * e.along[side] / 4;
        if (c.across[side]) sum += m.weft * e.across[side] * e.across[side] / 4;
      }
      if (c.whole) sum += m.coupling * e.mean_along() * e.mean_across();
      energy += c.weight * sum;
    }
  return energy;
}

namespace {

// Of the way from particle i of one row to particle k of another.
double square(ConstRow3 a, std::ptrdiff_t i, ConstRow3 b, std::ptrdiff_t k) {
  const double x = double(b.x[k]) - a.x[i], y = double(b.y[k]) - a.y[i],
               z = double(b.z[k]) - a.z[i];
  return x * x + y * y + z * z;
}

}  // namespace

double MembraneCells::energy(const Rows& x) const {
  assert(!stencils_[kRight].links);
  const Membrane& m = membrane_;
  const double uu = 1 / (hu_ * hu_), vv = 1 / (hv_ * hv_), uv = 1 / (4 * hu_ * hv_);
  double energy = 0;
  for (int j = 0; j + 1 < rows_; ++j) {
    const ConstRow3 row = x.row(j), next = x.row(j + 1);
    double sum = 0, l = 0, r = (square(row, 0, next, 0) * vv - 1) / 2;
    for (int i = 0; i + 1 < columns_; ++i) {
      l = std::exchange(r, (square(row, i + 1, next, i + 1) * vv - 1) / 2);
      const double t = (square(row, i, row, i + 1) * uu - 1) / 2;
      const double b = (square(next, i, next, i + 1) * uu - 1) / 2;
      const double shear = (square(row, i, next, i + 1) - square(next, i, row, i + 1)) * uv;
      sum += m.warp * (t * t + b * b) + m.weft * (l * l + r * r) + m.coupling * (t + b) * (l + r) +
             2 * m.shear * shear * shear;
    }
    energy += hu_ * hv_ * factor(j) * sum / 4;
  }
  return energy;
}

void MembraneCells::add_forces(const std::vector<Vec3>& x, const std::vector<Vec3>* v, double share,
                               double rate, std::vector<Vec3>& force) const {
  const Membrane& m = membrane_;
  for (int j = 0; j + 1 < rows_; ++j)
    for (int i = 0; i + 1 < columns_; ++i) {
      const Cell c = cell(i, j);
      Cell::Strain e = c.strain(x, x, hu_, hv_, 1, share);
      // de/dt = x_edge · v_edge/h² is twice what halves the square.
      const Cell::Strain r = v ? c.strain(x, *v, hu_, hv_, 0, 2 * rate) : Cell::Strain{};
      for (int side = 0; side < 2; ++side) {
        e.along[side] += r.along[side];
        e.across[side] += r.across[side];
      }
      e.shear += r.shear;
      const double across = c.whole ? m.coupling * e.mean_across() : 0;
      const double along = c.whole ? m.coupling * e.mean_along() : 0;
      const double u = c.weight / (2 * hu_ * hu_), w = c.weight / (2 * hv_ * hv_);
      const int* p = c.corner;
      for (int side = 0; side < 2; ++side) {
        if (c.along[side])
          add_pull(x, p[2 * side], p[2 * side + 1], u * (m.warp * e.along[side] + across), force);
        if (c.across[side])
          add_pull(x, p[side], p[side + 2], w * (m.weft * e.across[side] + along), force);
      }
      if (!c.sheared) continue;
      const double shear = c.weight * m.shear * e.shear / (2 * hu_ * hv_);
      add_pull(x, p[0], p[3], shear, force);
      add_pull(x, p[2], p[1], -shear, force);
    }
}

}  // namespace weft::physics
