#include "physics/model/mesh/triangle_constraint.h"

#include <Eigen/LU>

namespace weft::physics {
namespace {

using Matrix = Eigen::Matrix3d;
using Weights = Eigen::Matrix<double, 3, 6>;  // a_ki

// Corners that are one vertex, as those across the sides of a tetrahedron, have their weights together.
Weights weights_of(const RestTriangle& r) {
  Weights a = Weights::Zero();
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    const double far = r.away[k] * r.away_at[k] + r.own[k] * r.own_at[k];
    a(k, 3 + k) += r.away[k];
    a(k, last) += r.own[k];
    a(k, next) -= far;
    a(k, k) += far - r.away[k] - r.own[k];
  }
  for (int c = 0; c < 6; ++c)
    for (int d = 0; d < c; ++d)
      if (r.corner[std::size_t(c)] == r.corner[std::size_t(d)]) {
        a.col(d) += a.col(c);
        a.col(c).setZero();
      }
  return a;
}

}  // namespace

std::array<double, 6> hinge_matrix(const RestTriangle& r, double h,
                                   const std::function<double(int)>& inverse_mass) {
  const Weights a = weights_of(r);
  Matrix m, coupling = Matrix::Zero();
  m << r.moment[0], r.moment[3], r.moment[5], r.moment[3], r.moment[1], r.moment[4], r.moment[5],
      r.moment[4], r.moment[2];
  for (int c = 0; c < 6; ++c)
    if (r.corner[std::size_t(c)] >= 0)
      coupling += inverse_mass(r.corner[std::size_t(c)]) * a.col(c) * a.col(c).transpose();
  // The normal's share is no scalar: its greatest value keeps the step a short one.
  const Eigen::Vector3d bow(r.bow[0], r.bow[1], r.bow[2]);
  for (int c = 0; c < 3; ++c) {
    const double opposite = r.rest[(c + 1) % 3];
    coupling +=
        inverse_mass(r.corner[std::size_t(c)]) * opposite * opposite * bow * bow.transpose();
  }
  const Matrix stiff = h * h * m;
  const Matrix p = stiff * (Matrix::Identity() + coupling * stiff).inverse();
  return {p(0, 0), p(1, 1), p(2, 2), p(0, 1), p(1, 2), p(2, 0)};
}

}  // namespace weft::physics
