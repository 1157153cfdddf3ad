#include "physics/model/mesh/plate_moments.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace weft::physics {
namespace {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Corners = Eigen::Matrix<double, 6, 3>;  // of a triangle and those across its sides
using Vector9 = Eigen::Matrix<double, 9, 1>;  // of a vertex: three balances, six energies

constexpr double kHalfRoot = 0.70710678118654752;  // 1/√2

// Symmetric tensors as vectors: the product of two is that of the tensors.
Vector3 dyad(double a1, double a2, double b1, double b2) {
  return {a1 * b1, a2 * b2, (a1 * b2 + a2 * b1) * kHalfRoot};
}
Vector6 packed(const Matrix3& m) {
  Vector6 v;
  v << m(0, 0), m(1, 1), m(2, 2), (m(0, 1) + m(1, 0)) * kHalfRoot, (m(1, 2) + m(2, 1)) * kHalfRoot,
      (m(2, 0) + m(0, 2)) * kHalfRoot;
  return v;
}
Matrix3 unpacked(const Vector6& v) {
  const double a = v[3] * kHalfRoot, b = v[4] * kHalfRoot, c = v[5] * kHalfRoot;
  Matrix3 m;
  m << v[0], a, c, a, v[1], b, c, b, v[2];
  return m;
}

// What curvature along the normal, of twist and along the side adds to the slope of the flat triangle through
// the side and a corner, beside the slope in the middle of the side. `off`: of the corner [m], below 0 within.
Vector3 added_slope(double off, double at, double length) {
  return {off / 2, (at - 0.5) * length, -at * (1 - at) * length * length / (2 * off)};
}

// The share that the far triangle has of the slope at a side: where what curvatures add, all of them equally
// likely (those of twist count half), is least. Half where both are alike; slivers, whose slope says
// little, have less.
double share_of_far(const Vector3& own, const Vector3& away) {
  const Vector3 weight(1, 0.5, 1);
  const Vector3 difference = own - away;
  return difference.cwiseProduct(weight).dot(own) / difference.cwiseProduct(weight).dot(difference);
}

struct Element {
  Matrix3 curvature = Matrix3::Zero();  // B; of jumps
  // In the metric of the rigidities:
  Matrix3 seen = Matrix3::Zero();        // R
  Matrix3 wanted = Matrix3::Identity();  // W
  Corners pull = Corners::Zero();        // F
  double unit = 0;                       // m; of its unknowns
};

Element element_of(const Plate& plate, const Vector3& metric) {
  Element e;
  Matrix3 jumps = Matrix3::Zero();                                            // of curvatures
  Eigen::Matrix<double, 3, 6> corners = Eigen::Matrix<double, 3, 6>::Zero();  // jumps of places
  for (int k = 0; k < 3; ++k) {
    const Hinge& h = plate.hinge[k];
    const Vector3 normal = dyad(h.n1, h.n2, h.n1, h.n2);
    if (h.across < 0) {
      const Vector3 free = e.wanted * metric.asDiagonal() * normal;
      if (const double size = free.squaredNorm(); size > 0)
        e.wanted -= free * free.transpose() / size;
      continue;
    }
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    const Vector3 own = added_slope(-h.own.height, h.own.at, h.length);
    const Vector3 away = added_slope(h.away.height, h.away.at, h.length);
    e.curvature.col(k) = normal * (share_of_far(own, away) * h.length / plate.area);
    const Vector3 added = away - own;
    jumps.row(k) = added[0] * normal + added[1] * dyad(h.n1, h.n2, -h.n2, h.n1) +
                   added[2] * dyad(h.n2, -h.n1, h.n2, -h.n1);
    corners(k, 3 + k) += 1 / h.away.height;
    corners(k, last) += 1 / h.own.height;
    corners(k, next) -= h.away.at / h.away.height + h.own.at / h.own.height;
    corners(k, k) -= (1 - h.away.at) / h.away.height + (1 - h.own.at) / h.own.height;
  }
  const Matrix3 scaled = metric.asDiagonal() * e.curvature;
  e.seen = scaled * jumps * metric.cwiseInverse().asDiagonal();
  e.pull = plate.area * (scaled * corners).transpose();
  // As much for a large triangle as for many small ones, and for slivers, which see curvature many times over, no more
  // than for others.
  e.unit = std::sqrt(plate.area * std::max(1.0, e.seen.squaredNorm() / 3));
  return e;
}

// The equations of all vertices for by how much C of all triangles is more than 1, in their units.
class PatchTest {
 public:
  using Unknown = std::vector<Vector6>;
  using Residual = std::vector<Vector9>;

  PatchTest(const std::vector<Plate>& plates, const std::vector<Element>& elements,
            std::size_t vertices)
      : plates_(plates), elements_(elements), vertices_(vertices) {
    const std::vector<Scale> scale = scales();
    for (std::size_t t = 0; t < plates.size(); ++t) {
      Row r{elements[t].pull / elements[t].unit, {}};
      each_corner(t, [&](int c, std::size_t v) {
        r.pull.row(c) *= scale[v].balance;
        if (c < 3) r.energy[c] = plates[t].area * scale[v].energy / elements[t].unit;
      });
      rows_.push_back(r);
    }
  }

  // What is amiss with C = 1.
  Residual of_one() const {
    return residual([&](std::size_t t) {
      const Element& e = elements_[t];
      return Amiss{e.unit * (e.wanted - e.seen), e.unit * (e.wanted - e.seen.transpose() * e.seen)};
    });
  }
  // What C that is more than 1 by x changes.
  Residual times(const Unknown& x) const {
    return residual([&](std::size_t t) {
      const Matrix3& seen = elements_[t].seen;
      const Matrix3 moment = unpacked(x[t]) * seen;
      return Amiss{moment, seen.transpose() * moment};
    });
  }
  Unknown transposed_times(const Residual& amiss) const {
    Unknown x(rows_.size());
    for (std::size_t t = 0; t < rows_.size(); ++t) {
      const Matrix3& seen = elements_[t].seen;
      Corners at = Corners::Zero();
      Vector6 energies = Vector6::Zero();
      each_corner(t, [&](int c, std::size_t v) {
        at.row(c) = amiss[v].head<3>().transpose();
        if (c < 3) energies += rows_[t].energy[c] * amiss[v].tail<6>();
      });
      const Matrix3 pulls = rows_[t].pull.transpose() * at + seen * unpacked(energies);
      x[t] = packed(pulls * seen.transpose());
    }
    return x;
  }

 private:
  struct Amiss {
    Matrix3 moment, energy;
  };
  struct Scale {
    double balance = 0, energy = 0;  // 1 over the norm of a vertex's equations; 0: left out
  };
  struct Row {
    Corners pull;      // as of the triangle, for a unit and weighted as the vertices' equations are
    double energy[3];  // likewise, of its own corners
  };

  template <typename F>
  void each_corner(std::size_t t, F&& f) const {
    for (int c = 0; c < 6; ++c)
      if (const int v = plates_[t].corner[std::size_t(c)]; v >= 0) f(c, std::size_t(v));
  }

  template <typename F>
  Residual residual(F&& amiss) const {
    Residual all(vertices_, Vector9::Zero());
    for (std::size_t t = 0; t < rows_.size(); ++t) {
      const Amiss a = amiss(t);
      const Corners pulls = rows_[t].pull * a.moment;
      const Vector6 energy = packed(a.energy);
      each_corner(t, [&](int c, std::size_t v) {
        all[v].head<3>() += pulls.row(c).transpose();
        if (c < 3) all[v].tail<6>() += rows_[t].energy[c] * energy;
      });
    }
    return all;
  }

  std::vector<Scale> scales() const {
    constexpr double kEnergy = 0.5;  // how much an energy counts against a balance
    std::vector<Scale> scale(vertices_);
    for (std::size_t t = 0; t < plates_.size(); ++t)
      each_corner(t, [&](int c, std::size_t v) {
        scale[v].balance += elements_[t].pull.row(c).squaredNorm() / plates_[t].area;
        if (c < 3) scale[v].energy += plates_[t].area;
      });
    for (Scale& s : scale) {
      s.balance = s.balance > 0 ? 1 / std::sqrt(s.balance) : 0;
      s.energy = s.energy > 0 ? kEnergy / std::sqrt(s.energy) : 0;
    }
    leave_out_turns(scale);
    return scale;
  }

  // Where warp turns from triangle to triangle, as at seams of a pattern, no curvature is constant.
  void leave_out_turns(std::vector<Scale>& scale) const {
    constexpr double kAlike = 0.9;  // cosine
    for (const Plate& p : plates_)
      for (std::size_t k = 0; k < 3; ++k) {
        const Hinge& h = p.hinge[k];
        if (h.across < 0) continue;
        const Hinge& back = plates_[std::size_t(h.across)].hinge[h.side];
        if (h.n1 * back.n1 + h.n2 * back.n2 < -kAlike) continue;
        for (const std::size_t c : {k, (k + 1) % 3, (k + 2) % 3, 3 + k})
          scale[std::size_t(p.corner[c])] = {};
      }
  }

  const std::vector<Plate>& plates_;
  const std::vector<Element>& elements_;
  std::size_t vertices_;
  std::vector<Row> rows_;
};

template <typename V>
double squared(const std::vector<V>& all) {
  double sum = 0;
  for (const V& v : all) sum += v.squaredNorm();
  return sum;
}

template <typename V>
void add(std::vector<V>& to, double share, const std::vector<V>& more) {
  for (std::size_t n = 0; n < to.size(); ++n) to[n] += share * more[n];
}

// Conjugate gradients for least squares (Hestenes, Stiefel 1952).
PatchTest::Unknown nearest_to_one(const std::vector<Plate>& plates,
                                  const std::vector<Element>& elements, std::size_t vertices) {
  constexpr int kSteps = 24;
  const PatchTest test(plates, elements, vertices);
  PatchTest::Unknown x(plates.size(), Vector6::Zero());
  PatchTest::Residual r = test.of_one();
  PatchTest::Unknown gradient = test.transposed_times(r), way = gradient;
  double size = squared(gradient);
  double enough = 0;
  for (const Plate& p : plates) enough += 1e-12 * p.area;
  for (int n = 0; n < kSteps && size > enough; ++n) {
    const PatchTest::Residual moved = test.times(way);
    const double along = size / squared(moved);
    add(x, along, way);
    add(r, -along, moved);
    gradient = test.transposed_times(r);
    const double before = std::exchange(size, squared(gradient));
    for (std::size_t t = 0; t < way.size(); ++t) way[t] = gradient[t] + size / before * way[t];
  }
  return x;
}

// C within a fiftieth and fifty times of 1: no curvature is free, none is locked. Crossed diagonals come to it.
Matrix3 bounded(const Matrix3& c) {
  constexpr double kLeast = 0.02, kMost = 50;
  if ((c - Matrix3::Identity()).norm() <= 1 - kLeast) return c;
  const Eigen::SelfAdjointEigenSolver<Matrix3> parts(c);
  return parts.eigenvectors() * parts.eigenvalues().cwiseMax(kLeast).cwiseMin(kMost).asDiagonal() *
         parts.eigenvectors().transpose();
}

}  // namespace

std::vector<std::array<double, 6>> plate_moments(const std::vector<Plate>& plates,
                                                 std::size_t vertices, const Bending& bending) {
  const Vector3 rigidity(bending.warp, bending.weft, bending.twist);
  const Vector3 root = rigidity.cwiseSqrt();
  const Vector3 metric =
      root.cwiseMax(0.1 * root.maxCoeff());  // what resists nothing, too, has a length
  std::vector<Element> elements;
  elements.reserve(plates.size());
  for (const Plate& plate : plates) elements.push_back(element_of(plate, metric));
  const PatchTest::Unknown more = nearest_to_one(plates, elements, vertices);
  std::vector<std::array<double, 6>> moments(plates.size());
  for (std::size_t t = 0; t < plates.size(); ++t) {
    const Matrix3 c = bounded(Matrix3::Identity() + unpacked(more[t]) / elements[t].unit);
    const Matrix3 b = root.asDiagonal() * elements[t].curvature;
    const Matrix3 form = plates[t].area * b.transpose() * c * b;
    moments[t] = {form(0, 0), form(1, 1), form(2, 2), form(0, 1), form(1, 2), form(2, 0)};
  }
  return moments;
}

}  // namespace weft::physics
