// The stability limit of explicit springs (stability.h).
#include "physics/model/lattice/stability.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "physics/model/largest_eigenvalue.h"
#include "physics/model/lattice/bending.h"
#include "weft/random.h"

namespace weft::physics {
namespace {

// Lanczos steps without reorthogonalisation: lost orthogonality repeats the extreme eigenvalue, it
// does not move it. The remaining gap to the largest eigenvalue is covered by kMargin.
constexpr int kSteps = 40;
constexpr double kMargin = 1.02;

// Three values for every particle, laid out as the lattice; zero in the padding. Calls
// visit(component) with each of several fields' components.
template <class Visit, class... Fields>
void for_each_component(Visit&& visit, Fields&... fields) {
  visit(fields.row(0).x...);
  visit(fields.row(0).y...);
  visit(fields.row(0).z...);
}

// A = W^½ S W^½, S the sum of all springs' tangent stiffness or damping (kernels/tangent.cpp).
struct Operator {
  const Cloth& cloth;
  const std::vector<Stencil>& stencils;
  const Lattice& l;
  const KernelTable& kernels;
  bool damping;  // in place of the stiffness
  AlignedArray<float> root_w;
  Rows scaled;

  Operator(const Cloth& c, const std::vector<Stencil>& f, const Lattice& lattice,
           const KernelTable& k, bool of_damping)
      : cloth(c),
        stencils(f),
        l(lattice),
        kernels(k),
        damping(of_damping),
        root_w(lattice.inverse_mass.size()),
        scaled(lattice.rows, lattice.stride) {
    for (std::size_t p = 0; p < size(); ++p) root_w[p] = std::sqrt(l.inverse_mass[p]);
  }
  std::size_t size() const { return l.inverse_mass.size(); }

  // y = A u.
  void apply(Rows& u, Rows& y) {
    for_each_component(
        [&](float* to, const float* from) {
          for (std::size_t p = 0; p < size(); ++p) to[p] = root_w[p] * from[p];
        },
        scaled, u);
    y.clear();
    for (const Stencil& f : stencils)
      for (int j = 0; j + f.dj < l.rows; ++j) apply_row(f, j, y);
    if (cloth.bending.given() && !damping) apply_bending(y);
    for_each_component(
        [&](float* to) {
          for (std::size_t p = 0; p < size(); ++p) to[p] *= root_w[p];
        },
        y);
  }

  void apply_row(const Stencil& f, int j, Rows& y) {
    TangentRow r{};
    static_cast<FarRows&>(r) = far_rows(f, l.x, l.columns, j);
    const FarRows u = far_rows(f, scaled, l.columns, j);
    r.u_near = u.near;
    r.u_far = u.far;
    r.pull_near = y.row(j).from(f.near());
    r.pull_far = y.row(j + f.dj).from(f.far());
    r.rest = float(f.rest);
    r.stiffness = float(damping ? f.damping : f.stiffness) * float(row_factor(cloth, f, j));
    r.factor = column_factors(l, f);
    r.sideways = !damping;
    kernels.lattice.tangent(r);
  }

  void apply_bending(Rows& y) {
    for_each_bend(cloth, [&](double k, int count, const int* particles, const double* factor) {
      for (int c = 0; c < 3; ++c) {
        const auto value = [&](Rows& field, int q) -> float& {
          return field.at(c, particles[q] / l.columns, particles[q] % l.columns);
        };
        double d = 0;
        for (int q = 0; q < count; ++q) d += factor[q] * value(scaled, q);
        for (int q = 0; q < count; ++q) value(y, q) += float(k * factor[q] * d);
      }
    });
  }
};

// Eight sums side by side, in double.
double dot(Rows& a, Rows& b, std::size_t size) {
  constexpr int kSums = 8;
  double sums[kSums] = {};
  for_each_component(
      [&](const float* x, const float* y) {
        for (std::size_t p = 0; p < size; p += kSums)
          for (int n = 0; n < kSums; ++n) sums[n] += double(x[p + n]) * y[p + n];
      },
      a, b);
  return std::accumulate(sums, sums + kSums, 0.0);
}

// Largest eigenvalue of a symmetric positive operator.
double largest_eigenvalue(Operator& op) {
  const Lattice& l = op.l;
  const std::size_t size = op.size();
  Rows before(l.rows, l.stride), v(l.rows, l.stride), next(l.rows, l.stride);
  Random random(7, 0);
  for (int c = 0; c < 3; ++c)
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i) v.at(c, j, i) = float(random.symmetric());
  v.scale(float(1 / std::sqrt(dot(v, v, size))));
  std::vector<double> diagonal, off;
  double beta = 0;
  for (int step = 0; step < kSteps; ++step) {
    op.apply(v, next);
    const double alpha = dot(v, next, size);
    diagonal.push_back(alpha);
    for_each_component(
        [&](float* n, const float* a, const float* b) {
          for (std::size_t p = 0; p < size; ++p) n[p] -= float(alpha) * a[p] + float(beta) * b[p];
        },
        next, v, before);
    beta = std::sqrt(dot(next, next, size));
    if (!(beta > 1e-12 * std::abs(alpha))) break;
    std::swap(before, v);
    std::swap(v, next);
    v.scale(float(1 / beta));
    off.push_back(beta);
  }
  const int m = int(diagonal.size());
  Eigen::VectorXd d = Eigen::Map<Eigen::VectorXd>(diagonal.data(), m);
  Eigen::VectorXd e =
      m > 1 ? Eigen::VectorXd(Eigen::Map<Eigen::VectorXd>(off.data(), m - 1)) : Eigen::VectorXd();
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(d, e, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().maxCoeff();
}

double largest(const Cloth& cloth, const std::vector<Stencil>& stencils, const Lattice& l,
               const KernelTable& kernels, bool damping) {
  Operator op(cloth, stencils, l, kernels, damping);
  return std::max(0.0, largest_eigenvalue(op)) * kMargin;
}

}  // namespace

Spectrum estimate_spectrum(const Cloth& cloth, const std::vector<Stencil>& stencils,
                           const Lattice& l, bool damped, const KernelTable& kernels) {
  Spectrum spectrum;
  spectrum.omega_squared = largest(cloth, stencils, l, kernels, false);
  if (damped) spectrum.damping = largest(cloth, stencils, l, kernels, true);
  return spectrum;
}

Spectrum membrane_spectrum(const Cloth& cloth, const MembraneCells& cells, const Lattice& l) {
  const std::vector<Vec3> rest = l.gather(l.x);
  std::vector<double> root;  // of inverse masses
  for (int p = 0; p < l.count(); ++p) root.push_back(std::sqrt(double(l.inverse_mass[l.lane(p)])));
  // M^-1/2 K M^-1/2: pulls by displacements are those by velocities of a membrane without stress.
  std::vector<Vec3> moved(rest.size()), pull(rest.size());
  const Bending& bending = cloth.bending;
  const auto apply = [&](double stretch, double bend, const std::vector<double>& u,
                         std::vector<double>& y) {
    for (std::size_t n = 0; n < u.size(); ++n) moved[n / 3][n % 3] = root[n / 3] * u[n];
    std::fill(pull.begin(), pull.end(), Vec3{});
    cells.add_forces(rest, &moved, 0, stretch, pull);
    if (bend > 0)
      add_bending_forces(
          cloth, [&](int p, int c) { return bend * moved[std::size_t(p)][std::size_t(c)]; }, pull);
    for (std::size_t n = 0; n < u.size(); ++n) y[n] = -root[n / 3] * pull[n / 3][n % 3];
  };
  const auto largest = [&](double stretch, double bend) {
    return largest_eigenvalue(3 * rest.size(),
                              [&](const auto& u, auto& y) { apply(stretch, bend, u, y); });
  };
  Spectrum spectrum;
  spectrum.omega_squared = largest(1, bending.given() ? 1 : 0);
  if (cells.damping() > 0 || bending.damping > 0)
    spectrum.damping = largest(cells.damping(), bending.damping);
  return spectrum;
}

double lightest_mass(const Cloth& cloth) {
  if (cloth.masses.empty()) return particle_mass(cloth, cloth.grid.nx / 2, cloth.grid.ny / 2);
  return *std::min_element(cloth.masses.begin(), cloth.masses.end());
}

}  // namespace weft::physics
