// The compliant method on meshes in double precision, to compare with.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "mesh_scenes.h"
#include "physics/model/mesh/batches.h"
#include "physics/model/mesh/mesh_attachments.h"
#include "physics/model/mesh/mesh_edges.h"
#include "physics/model/mesh/strands.h"
#include "weft/vec3.h"

namespace weft {

// A way to sweep a mesh.
struct Way {
  const char* name;
  Sweep sweep;
  int order, iterations;
  double bending;
};

// The compliant method in double precision, after Macklin, Müller, Chentanez 2016. What is projected, others say.
class Oracle {
 public:
  Oracle(const Scene& scene, const std::vector<Vec3>& start)
      : scene_(scene),
        cloth_(scene.cloths[0]),
        mesh_(*cloth_.mesh.shape),
        triangles_(physics::rest_triangles(mesh_, {mesh_.vertices}, cloth_.bending)),
        dt_(scene.time.frame / scene.time.substeps),
        w_(start.size()) {
    for (const Vec3& p : start) x_.emplace_back(p[0], p[1], p[2]);
    v_.assign(start.size(), Eigen::Vector3d::Zero());
    for (const auto& r : triangles_)
      for (std::size_t k = 0; k < 3; ++k)
        w_[std::size_t(r.corner[k])] += cloth_.density * r.area / 3;
    for (double& w : w_) w = 1 / w;
    for (const Pin& pin : cloth_.pins) w_[std::size_t(pin.i)] = 0;
  }
  virtual ~Oracle() = default;

  void substep(bool first) {
    const Eigen::Vector3d g(scene_.gravity[0], scene_.gravity[1], scene_.gravity[2]);
    const double kick = first ? dt_ / 2 : dt_;
    before_ = x_;
    for (std::size_t p = 0; p < x_.size(); ++p) {
      if (w_[p] == 0) continue;
      v_[p] = v_[p] * (1 - kick * cloth_.drag) + kick * g;
      x_[p] += dt_ * v_[p];
    }
    const Places predicted = x_;
    project();
    for (std::size_t p = 0; p < x_.size(); ++p) v_[p] += (x_[p] - predicted[p]) / dt_;
  }
  std::vector<Vec3> positions() const {
    std::vector<Vec3> x;
    for (const Eigen::Vector3d& p : x_) x.push_back({p[0], p[1], p[2]});
    return x;
  }

 protected:
  using Places = std::vector<Eigen::Vector3d>;
  virtual void project() = 0;

  const Scene& scene_;
  const Cloth& cloth_;
  const TriangleMesh& mesh_;
  std::vector<physics::RestTriangle> triangles_;
  double dt_;
  std::vector<double> w_;
  Places x_, v_, before_;  // before_: of the last substep
};

// Springs along edges, and bending; constraints of several rows by a dense solver.
class EdgeOracle final : public Oracle {
 public:
  EdgeOracle(const Scene& scene, const std::vector<Vec3>& start)
      : Oracle(scene, start), edges_(physics::edges_of(mesh_, mesh_.vertices)) {}

 private:
  void project() override {
    lambda_.assign(edges_.ends.size(), 0);
    for (int n = 0; n < scene_.solver.iterations; ++n) stretch();
    if (cloth_.bending.given()) bend();
  }
  double compliance(int e) const {
    const double k = cloth_.stiffness.structural / 2 * edges_.triangles[std::size_t(e)];
    return 1 / (k * dt_ * dt_);
  }
  void stretch() {
    if (scene_.solver.sweep == Sweep::line) {
      const auto strands = physics::strands_of(edges_, mesh_.vertices);
      for (const auto& colour : physics::coloured_strands(strands, int(x_.size())))
        for (const int s : colour) solve(strands[std::size_t(s)].edges);
      return;
    }
    std::vector<physics::Corners> elements;
    for (const auto& [a, b] : edges_.ends) elements.push_back({a, b, -1, -1, -1, -1});
    for (const auto& colour : physics::coloured_batches(physics::order_of(mesh_), elements))
      for (const auto& batch : colour.elements)
        for (const int e : batch) solve({e});
  }
  // Some edges together.
  void solve(const std::vector<int>& some) {
    const auto count = Eigen::Index(some.size());
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(count, 3 * Eigen::Index(x_.size()));
    Eigen::MatrixXd weighted = gradient, system(count, count);
    Eigen::VectorXd right(count);
    system.setZero();
    for (Eigen::Index n = 0; n < count; ++n) {
      const int e = some[std::size_t(n)];
      const auto& [a, b] = edges_.ends[std::size_t(e)];
      const Eigen::Vector3d d = x_[std::size_t(b)] - x_[std::size_t(a)];
      for (const auto& [p, sign] : {std::pair(a, -1.0), std::pair(b, 1.0)}) {
        gradient.block<1, 3>(n, 3 * p) = sign * d.normalized().transpose();
        weighted.block<1, 3>(n, 3 * p) = w_[std::size_t(p)] * gradient.block<1, 3>(n, 3 * p);
      }
      const double alpha = compliance(e);
      system(n, n) = alpha;
      right[n] = -(d.norm() - edges_.rest[std::size_t(e)]) - alpha * lambda_[std::size_t(e)];
    }
    system += gradient * weighted.transpose();
    const Eigen::VectorXd change = system.ldlt().solve(right);
    for (Eigen::Index n = 0; n < count; ++n)
      lambda_[std::size_t(some[std::size_t(n)])] += change[n];
    const Eigen::VectorXd move = weighted.transpose() * change;
    for (std::size_t p = 0; p < x_.size(); ++p) x_[p] += move.segment<3>(3 * Eigen::Index(p));
  }
  // One triangle after the other: a step towards the least of ½ Δx M Δx/dt² + ½ Σ M_kl J_k J_l, exact as J
  // is linear.
  void bend() {
    std::vector<physics::Corners> elements;
    for (const auto& r : triangles_) elements.push_back(r.corner);
    for (const auto& colour : physics::coloured_batches(physics::order_of(mesh_), elements))
      for (const auto& batch : colour.elements)
        for (const int t : batch) bend(triangles_[std::size_t(t)]);
  }
  void bend(const physics::RestTriangle& r) {
    std::vector<std::size_t> free;
    for (const int c : r.corner)
      if (c >= 0 && w_[std::size_t(c)] > 0) free.push_back(std::size_t(c));
    // Forces are linear in the positions: their matrix by unit moves.
    physics::MeshMaterial material{};
    material.bends = true;
    std::vector<Vec3> x = positions();
    const auto force = [&] {
      std::vector<Vec3> f(x.size());
      physics::add_mesh_forces({r}, material, x, nullptr, f);
      Eigen::MatrixXd all(Eigen::Index(free.size()), 3);
      for (std::size_t n = 0; n < free.size(); ++n)
        for (std::size_t k = 0; k < 3; ++k) all(Eigen::Index(n), Eigen::Index(k)) = f[free[n]][k];
      return all;
    };
    const Eigen::MatrixXd now = force();
    const auto count = Eigen::Index(free.size());
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index n = 0; n < count; ++n) {
      x[free[std::size_t(n)]][1] += 1;
      system.col(n) = -(force() - now).col(1);
      x[free[std::size_t(n)]][1] -= 1;
      system(n, n) += 1 / (w_[free[std::size_t(n)]] * dt_ * dt_);
    }
    const Eigen::MatrixXd move = system.fullPivLu().solve(now);
    for (Eigen::Index n = 0; n < count; ++n) x_[free[std::size_t(n)]] += move.row(n).transpose();
  }

  physics::MeshEdges edges_;
  std::vector<double> lambda_;
};

}  // namespace weft
