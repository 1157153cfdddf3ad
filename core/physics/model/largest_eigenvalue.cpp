#include "physics/model/largest_eigenvalue.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "weft/random.h"

namespace weft::physics {

double largest_eigenvalue(
    std::size_t size,
    const std::function<void(const std::vector<double>& u, std::vector<double>& y)>& apply) {
  // Without reorthogonalisation: lost orthogonality repeats the extreme eigenvalue, it does not move it.
  constexpr int kSteps = 40;
  constexpr double kMargin = 1.02;  // covers what is left to the largest
  std::vector<double> before(size), v(size), next(size);
  Random random(7, 0);
  for (double& value : v) value = random.symmetric();
  const auto scale = [](std::vector<double>& u, double by) {
    for (double& value : u) value *= by;
  };
  const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  scale(v, 1 / std::sqrt(product(v, v)));
  std::vector<double> diagonal, off;
  double beta = 0;
  for (int step = 0; step < kSteps; ++step) {
    apply(v, next);
    const double alpha = product(v, next);
    diagonal.push_back(alpha);
    for (std::size_t n = 0; n < size; ++n) next[n] -= alpha * v[n] + beta * before[n];
    beta = std::sqrt(product(next, next));
    if (!(beta > 1e-12 * std::abs(alpha))) break;
    std::swap(before, v);
    std::swap(v, next);
    scale(v, 1 / beta);
    off.push_back(beta);
  }
  const auto m = Eigen::Index(diagonal.size());
  const Eigen::VectorXd d = Eigen::Map<Eigen::VectorXd>(diagonal.data(), m);
  Eigen::VectorXd e(m - 1);
  std::copy_n(off.begin(), m - 1, e.data());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(d, e, Eigen::EigenvaluesOnly);
  return std::max(0.0, solver.eigenvalues().maxCoeff()) * kMargin;
}

}  // namespace weft::physics
