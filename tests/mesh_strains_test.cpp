// The membrane of meshes by method compliant: sweeps beside double precision, motion and rest as by forces and in
// closed form, what is kept.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "mesh_oracle.h"
#include "mesh_strain_scenes.h"
#include "truth.h"

namespace weft {
namespace {

// The sweeps in double precision by dense matrices, with strains from the deformation gradient.
class StrainOracle final : public Oracle {
 public:
  StrainOracle(const Scene& scene, const std::vector<Vec3>& start) : Oracle(scene, start) {
    const Membrane& m = cloth_.membrane;
    c_ << m.warp, m.coupling, 0, m.coupling, m.weft, 0, 0, 0, m.shear;
  }

 private:
  using Gradient = Eigen::Matrix<double, 3, 2>;
  Gradient gradient(std::size_t t, const Places& x) const {
    const auto& r = triangles_[t];
    Eigen::Matrix<double, 3, 2> sides;
    for (int k = 0; k < 2; ++k)
      sides.col(k) = x[std::size_t(r.corner[std::size_t(k + 1)])] - x[std::size_t(r.corner[0])];
    Eigen::Matrix2d d;
    d << r.du[0], r.dv[0], r.du[1], r.dv[1];
    return sides * d;
  }
  void project() override {
    std::vector<physics::Corners> elements;
    for (const auto& r : triangles_)
      elements.push_back({r.corner[0], r.corner[1], r.corner[2], -1, -1, -1});
    const auto colours = physics::coloured_batches(physics::order_of(mesh_), elements);
    const auto sweep = [&](bool damps) {
      stress_.assign(triangles_.size(), Eigen::Vector3d::Zero());
      for (int n = 0; n < scene_.solver.iterations; ++n)
        for (const auto& colour : colours)
          for (const auto& batch : colour.elements)
            for (const int t : batch) solve(std::size_t(t), damps);
    };
    if (cloth_.membrane.damping > 0) sweep(true);
    sweep(false);
  }
  static Eigen::Vector3d strain(const Eigen::Matrix2d& metric) {
    return {(metric(0, 0) - 1) / 2, (metric(1, 1) - 1) / 2, metric(0, 1)};
  }
  // Of strains, or before that of how they have grown in the substep.
  void solve(std::size_t t, bool damps) {
    const auto& r = triangles_[t];
    const Gradient f = gradient(t, x_), f0 = gradient(t, before_);
    const Eigen::Matrix2d metric = f.transpose() * f;
    const double rate = cloth_.membrane.damping / dt_, scale = dt_ * dt_ * r.area;
    const Eigen::Vector3d e = strain(metric), now = e - strain(f0.transpose() * f0);
    const Eigen::Vector3d residual = (damps ? rate * now : e) + c_.inverse() * stress_[t];
    // Rows of a corner's gradient are products of its weights with the gradient's columns: A by a root of the
    // raised metric in their place.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal(metric);
    const Eigen::Matrix2d root = principal.eigenvectors() *
                                 principal.eigenvalues().cwiseMax(1).cwiseSqrt().asDiagonal() *
                                 principal.eigenvectors().transpose();
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    const double du[3] = {-r.du[0] - r.du[1], r.du[0], r.du[1]},
                 dv[3] = {-r.dv[0] - r.dv[1], r.dv[0], r.dv[1]};
    for (std::size_t k = 0; k < 3; ++k) {
      Eigen::Matrix<double, 3, 2> rows;
      rows.row(0) = du[k] * root.col(0).transpose();
      rows.row(1) = dv[k] * root.col(1).transpose();
      rows.row(2) = (dv[k] * root.col(0) + du[k] * root.col(1)).transpose();
      a += w_[std::size_t(r.corner[k])] * rows * rows.transpose();
    }
    const Eigen::Matrix3d system = (damps ? rate : 1) * scale * a + c_.inverse();
    const Eigen::Vector3d by = system.ldlt().solve(residual);
    stress_[t] -= by;
    for (std::size_t k = 0; k < 3; ++k)
      x_[std::size_t(r.corner[k])] -=
          scale * w_[std::size_t(r.corner[k])] *
          (f.col(0) * (du[k] * by[0] + dv[k] * by[2]) + f.col(1) * (du[k] * by[2] + dv[k] * by[1]));
  }

  Eigen::Matrix3d c_;
  Places stress_;
};

// Of a substep; a note tells where they are two in place of one.
int sweeps_of(const Scene& scene) {
  const Simulation run(scene, {.threads = 1});
  const auto& notes = run.plan().notes;
  const bool more = std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("2 run in place of 1") != note.npos;
  });
  return more ? 2 : scene.solver.iterations;
}

TEST(MeshStrains, DoWhatTheEquationsSay) {
  const auto mesh = made_up({.nx = 9, .ny = 8, .shift = 0.3, .shuffled = true});
  for (const Membrane& membrane : {kCanvas, kIsotropic, kDamped})
    for (const int iterations : {1, 3}) {
      Scene scene = projected(mesh, membrane, 1, 4, iterations);
      scene.time.frame = 0.004;
      scene.cloths[0].pins = {{5, 0, {}}, {40, 0, {}}};
      Simulation run(scene, {.threads = 1});
      const std::vector<Vec3> rounded = rumple(run, *mesh, 0.01, 7);
      StrainOracle oracle(scene, rounded);
      run.advance_frame();
      for (int n = 0; n < 4; ++n) oracle.substep(n == 0);
      EXPECT_GT(farthest(rounded, positions_of(run)), 1e-3);
      EXPECT_LT(farthest(oracle.positions(), positions_of(run)), 3e-6) << iterations;
    }
}

TEST(MeshStrains, MoveAsForcesInFineSubsteps) {
  constexpr double kFloor = 1.5e-4;  // m; how far forces are from finer substeps themselves, about
  for (const Membrane& membrane : {kCanvas, kIsotropic, kDamped})
    for (const int order : {1, 2}) {
      const std::vector<Vec3> truth = after(by_forces(curtain(17, membrane, 1, 1)), 30);
      double coarse[2];
      for (const Sweep sweep : kSweeps)
        for (const int iterations : {1, 2}) {
          double before = 1;
          int most = 0;  // sweeps, since one may be two in short substeps of what is stiff
          for (const int substeps : {16, 32, 64, 128, 256}) {
            Scene scene = curtain(17, membrane, order, substeps, iterations);
            scene.solver.sweep = sweep;
            const int sweeps = sweeps_of(scene);
            const double error = apart(after(scene, 30), truth);
            if (sweeps >= most) {
              EXPECT_LT(error, std::max(before / 1.3, kFloor)) << order << " " << substeps;
            }
            most = sweeps;
            before = error;
            if (substeps == 16 && iterations == 1) coarse[sweep == Sweep::line] = error;
          }
          EXPECT_LT(before, order == 2 ? 2e-4 : 1e-3);
        }
      // Strands pass a pull on; where both are damped, colours have less to pass.
      EXPECT_LT(coarse[1], membrane.damping > 0 ? coarse[0] : coarse[0] / 1.5);
    }
}

// Damping takes what it should, however many sweeps share it.
TEST(MeshStrains, DampAsForcesInAnyNumberOfSweeps) {
  for (const double damping : {5e-4, 2e-3}) {
    const Membrane membrane{3000, 2000, 200, 80, damping};
    const std::vector<Vec3> truth = after(by_forces(curtain(13, membrane, 1, 1)), 30);
    for (const int order : {1, 2})
      for (const Sweep sweep : kSweeps)
        for (const int iterations : {1, 2, 3, 6}) {
          Scene scene = curtain(13, membrane, order, order == 1 ? 512 : 128, iterations);
          scene.solver.sweep = sweep;
          EXPECT_LT(apart(after(scene, 30), truth), 4e-4)
              << damping << ", order " << order << ", sweep " << int(sweep) << ", " << iterations;
        }
  }
}

// Starts stretched, turning and rough, in free flight.
TEST(MeshStrains, KeepMomentumAndGainNoEnergy) {
  const auto mesh = made_up({.nx = 15, .ny = 13, .shift = 0.3});
  for (const Membrane& membrane : {kCanvas, kIsotropic, kDamped})
    for (const auto& [order, sweep] : {std::pair(1, Sweep::gauss_seidel),
                                       {2, Sweep::gauss_seidel},
                                       {1, Sweep::line},
                                       {2, Sweep::line}})
      for (const int substeps : {16, 64, 256}) {
        Scene scene = projected(mesh, membrane, order, substeps, order);
        scene.solver.sweep = sweep;
        scene.gravity = {};
        scene.cloths[0].velocity = {0.3, 0.1, -0.2};
        scene.cloths[0].spin = {0.5, 1, 0.2};
        Simulation run(scene, {.threads = 1});
        const std::vector<double> v = run.velocities();
        run.set_state(flat(rumpled(*mesh, 0.005, 5)), v);
        const Report start = run.report(false);
        for (int n = 0; n < 20; ++n) run.advance_frame();
        const Report end = run.report(false);
        const double drift = length(minus(end.momentum, start.momentum));
        const double angular = length(minus(end.angular_momentum, start.angular_momentum));
        // Strands of long substeps find velocities from positions, which are rounded.
        const double rounding = sweep == Sweep::line && substeps < 64 ? 2e-3 : 2e-5;
        EXPECT_LT(drift, rounding * length(start.momentum)) << order << " " << substeps;
        EXPECT_LT(angular, 0.5 / substeps * length(start.angular_momentum)) << order << substeps;
        EXPECT_LT(end.energy.total, start.energy.total) << order << " " << substeps;
        EXPECT_FALSE(run.plan().fallback);
      }
}

// A strip that hangs by its side is stretched by what is below; substeps are short enough for single sweeps to
// hold it up.
TEST(MeshStrains, StretchAsTheContinuumDoes) {
  for (const double shift : {0.0, 0.3})
    for (const Sweep sweep : kSweeps) {
      const auto mesh = made_up({.nx = 9, .ny = 25, .width = 0.3, .height = 1, .shift = shift});
      Scene scene = projected(mesh, {400, 250, 0, 100, 0}, shift > 0 ? 1 : 2, 100);
      scene.solver.sweep = sweep;
      Cloth& cloth = scene.cloths[0];
      cloth.drag = 5;
      scene.gravity = {0, 0, 9.81};
      for (std::size_t n = 0; n < mesh->vertices.size(); ++n)
        if (mesh->vertices[n][2] == 0) cloth.pins.push_back({int(n), 0, {}});
      const auto x = after(scene, 200);
      double end = 0;
      for (std::size_t n = 0; n < x.size(); ++n)
        if (mesh->vertices[n][2] == 1) end += x[n][2] / 9;
      EXPECT_NEAR(end, hung_length(125), 2e-4) << shift;
    }
}

// Drawn out along x with its other sides free: no stress across, so that e22 = -C12/C22 e11, everywhere alike.
TEST(MeshStrains, NarrowAsTheMaterialSays) {
  for (const Membrane& membrane :
       {Membrane{900, 700, 350, 200, 0}, Membrane{900, 700, -300, 80, 0}})
    for (const Sweep sweep : kSweeps) {
      const auto mesh = made_up({.nx = 13, .ny = 9, .height = 0.6, .shift = 0.3});
      Scene scene = projected(mesh, membrane, 1, 200);
      scene.solver.sweep = sweep;
      scene.gravity = {};
      scene.cloths[0].drag = 5;
      const double along = 1.08, e11 = (along * along - 1) / 2;
      const double across = std::sqrt(1 - 2 * membrane.coupling / membrane.weft * e11);
      const auto there = [&](const Vec3& p) {
        return Vec3{along * p[0], 0, 0.3 + across * (p[2] - 0.3)};
      };
      std::vector<Vec3> expected;
      for (std::size_t n = 0; n < mesh->vertices.size(); ++n) {
        expected.push_back(there(mesh->vertices[n]));
        if (mesh->vertices[n][0] == 0 || mesh->vertices[n][0] == 1)
          scene.cloths[0].pins.push_back({int(n), 0, {{0, expected.back()}}});
      }
      const bool lines = sweep == Sweep::line;
      expect({"membrane of irregular triangles drawn out by 8 %, places of all vertices",
              std::string(membrane.coupling > 0 ? "C12 > 0" : "C12 < 0") +
                  (lines ? ", lines" : ", Gauss-Seidel"),
              0, 1e-4, "m"},
             farthest(after(scene, 200), expected));
    }
}

// Threads at an angle, by texture coordinates: at rest where forces are.
TEST(MeshStrains, ComeToTheRestOfForces) {
  auto mesh = std::make_shared<TriangleMesh>(*made_up({.nx = 11, .ny = 11, .shift = 0.3}));
  const double c = std::cos(0.6), s = std::sin(0.6);
  for (const auto& t : mesh->triangles) {
    auto& uv = mesh->uv.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& at = mesh->vertices[std::size_t(t[k])];
      uv[k] = {c * at[0] + s * at[2], c * at[2] - s * at[0]};
    }
  }
  for (const Sweep sweep : kSweeps) {
    Scene scene = projected(mesh, {300, 150, 60, 30, 0}, 1, 64);
    scene.solver.sweep = sweep;
    scene.gravity = {0, -3, 9};
    scene.cloths[0].drag = 6;
    scene.cloths[0].bending = 1e-4;
    for (int n = 0; n < 11; ++n) scene.cloths[0].pins.push_back({n, 0, {}});
    EXPECT_LT(farthest(after(scene, 300), after(by_forces(scene), 300)), 1e-4);
  }
}

// What is mirrored moves as its mirror image does: corners come in another order, and so do sums.
TEST(MeshStrains, KnowNoLeftAndRight) {
  const auto mesh = made_up({.nx = 14, .ny = 12, .shift = 0.3, .shuffled = true});
  auto image = std::make_shared<TriangleMesh>(*mesh);
  for (Vec3& p : image->vertices) p[0] = -p[0];
  for (auto& [a, b, c] : image->triangles) std::swap(b, c);
  for (const Membrane& membrane : {kCanvas, kIsotropic, kDamped}) {
    std::vector<Vec3> x[2];
    for (const bool mirrored : {false, true}) {
      Scene scene = projected(mirrored ? image : mesh, membrane, 1, 16);
      scene.gravity = {mirrored ? -1.0 : 1.0, -9, 2};
      scene.cloths[0].pins = {{3, 0, {}}, {100, 0, {}}};
      x[mirrored] = after(scene, 10);
    }
    for (Vec3& p : x[1]) p[0] = -p[0];
    EXPECT_LT(farthest(x[0], x[1]), 2e-5);
  }
}

}  // namespace
}  // namespace weft
