// The stability limit of explicit springs (stability.h).
#include "physics/stability.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/bending.h"
#include "physics/random.h"

namespace weft::physics {
namespace {

using Field = std::vector<float>;  // 3 planes of one value per particle

// Lanczos steps without reorthogonalisation: lost orthogonality repeats the extreme eigenvalue, it
// does not move it. The remaining gap to the largest eigenvalue is covered by kMargin.
constexpr int kSteps = 40;
constexpr double kMargin = 1.02;

// y = A x for A = W^½ S W^½, S the sum over springs of c_n n nᵀ + c_t (I - n nᵀ), where the pair
// (c_n, c_t) of a spring is coefficients(k, damping, l/|e|).
template <class Coefficients>
struct Operator {
  const Cloth& cloth;
  const std::vector<Family>& families;
  const Lattice& l;
  bool bending;  // the curvature energy's share too
  Field root_w;
  Coefficients coefficients;

  void apply(const Field& x, Field& y) const {
    const std::size_t n = root_w.size();
    Field scaled(3 * n);
    for (int c = 0; c < 3; ++c)
      for (std::size_t p = 0; p < n; ++p) scaled[c * n + p] = root_w[p] * x[c * n + p];
    std::fill(y.begin(), y.end(), 0.0f);
    for (const Family& f : families)
      for (int j = 0; j + f.dj < l.rows; ++j) apply_row(f, j, scaled, y);
    if (bending) apply_bending(scaled, y);
    for (int c = 0; c < 3; ++c)
      for (std::size_t p = 0; p < n; ++p) y[c * n + p] *= root_w[p];
  }

  void apply_bending(const Field& x, Field& y) const {
    const std::size_t n = root_w.size();
    for_each_bend(cloth, [&](double k, int count, const int* particles, const double* factor) {
      for (int c = 0; c < 3; ++c) {
        double d = 0;
        for (int q = 0; q < count; ++q) d += factor[q] * x[c * n + particles[q]];
        for (int q = 0; q < count; ++q) y[c * n + particles[q]] += float(k * factor[q] * d);
      }
    });
  }

  void apply_row(const Family& f, int j, const Field& x, Field& y) const {
    const std::size_t n = root_w.size();
    const float factor = float(gradient_factor(cloth, j, f.dj));
    const float rest = float(f.rest);
    for (int m = 0; m < f.per_row(l.columns); ++m) {
      if (!f.alive(j, m)) continue;
      const int ia = m + f.near(), ib = m + f.far();
      const std::size_t a = std::size_t(j) * l.columns + ia;
      const std::size_t b = std::size_t(j + f.dj) * l.columns + ib;
      float e[3], d[3], squared = 1e-30f, along = 0;
      for (int c = 0; c < 3; ++c) {
        e[c] = l.x.at(c, j + f.dj, ib) - l.x.at(c, j, ia);
        d[c] = x[c * n + a] - x[c * n + b];
        squared += e[c] * e[c];
        along += e[c] * d[c];
      }
      const auto [normal, transverse] = coefficients(f, factor, rest / std::sqrt(squared));
      const float s = (normal - transverse) * along / squared;
      for (int c = 0; c < 3; ++c) {
        const float g = s * e[c] + transverse * d[c];
        y[c * n + a] += g;
        y[c * n + b] -= g;
      }
    }
  }
};

double dot(const Field& a, const Field& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += double(a[i]) * b[i];
  return sum;
}

// Largest eigenvalue of a symmetric positive operator.
template <class Operator>
double largest_eigenvalue(const Operator& op) {
  const std::size_t size = 3 * op.root_w.size();
  Field before(size), v(size), next(size);
  Random random(7, 0);
  for (float& c : v) c = float(random.symmetric());
  const double norm = std::sqrt(dot(v, v));
  for (float& c : v) c = float(c / norm);
  std::vector<double> diagonal, off;
  double beta = 0;
  for (int step = 0; step < kSteps; ++step) {
    op.apply(v, next);
    const double alpha = dot(v, next);
    diagonal.push_back(alpha);
    for (std::size_t i = 0; i < size; ++i) next[i] -= float(alpha) * v[i] + float(beta) * before[i];
    beta = std::sqrt(dot(next, next));
    if (!(beta > 1e-12 * std::abs(alpha))) break;
    for (std::size_t i = 0; i < size; ++i) {
      before[i] = v[i];
      v[i] = float(next[i] / beta);
    }
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

template <class Coefficients>
double largest(const Cloth& cloth, const std::vector<Family>& families, const Lattice& l,
               bool bending, Coefficients coefficients) {
  Operator<Coefficients> op{cloth, families, l, bending, {}, coefficients};
  op.root_w.reserve(std::size_t(l.columns) * l.rows);
  for (int j = 0; j < l.rows; ++j)
    for (int i = 0; i < l.columns; ++i) op.root_w.push_back(std::sqrt(l.w(j, i)));
  return std::max(0.0, largest_eigenvalue(op)) * kMargin;
}

}  // namespace

double Spectrum::largest_substep() const {
  // Root of dt² ω²/4 + dt c/2 = 1.
  const double root = damping / 2 + std::sqrt(damping * damping / 4 + omega_squared);
  return root > 0 ? 2 / root : std::numeric_limits<double>::infinity();
}

Spectrum estimate_spectrum(const Cloth& cloth, const std::vector<Family>& families,
                           const Lattice& l, bool damped) {
  struct Pair {
    float normal, transverse;
  };
  Spectrum spectrum;
  spectrum.omega_squared = largest(cloth, families, l, cloth.bending > 0,
                                   [](const Family& f, float factor, float ratio) {
                                     const float k = float(f.stiffness) * factor;
                                     return Pair{k, k * std::max(0.0f, 1 - ratio)};
                                   });
  if (damped)
    spectrum.damping = largest(cloth, families, l, false, [](const Family& f, float factor, float) {
      return Pair{float(f.damping) * factor, 0};
    });
  return spectrum;
}

double projection_substep(const Scene& scene) {
  constexpr double kSag = 0.02;
  constexpr double kJacobi = 0.3;  // of what a Gauss-Seidel sweep does: it takes means
  const Vec3& a = scene.gravity;
  const double g = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  const Solver& solver = scene.solver;
  if (solver.sweep == Sweep::line || solver.tethers || !(g > 0)) return kLongestProjection;
  const double sweeps = solver.iterations * (solver.sweep == Sweep::jacobi ? kJacobi : 1);
  double dt = kLongestProjection;
  for (const Cloth& c : scene.cloths) {
    const double points_over_spacing =
        std::max(c.grid.nx / spacing_u(c.grid), c.grid.ny / spacing_v(c.grid));
    double needed = std::sqrt(kSag * sweeps / (2 * g * points_over_spacing));
    if (solver.method != Method::positional) {
      double lightest = particle_mass(c, 0, 0);
      for (const double mass : c.masses) lightest = std::min(lightest, mass);
      const double k = std::max({c.stiffness.structural, c.stiffness.shear, c.stiffness.bend});
      needed = std::max(needed, std::sqrt(lightest / std::max(k, 1e-12)));
    }
    dt = std::min(dt, needed);
  }
  return dt;
}

}  // namespace weft::physics
