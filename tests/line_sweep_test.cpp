// Line sweeps against a dense solution in double, and the same bits at every width.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "physics/model/lattice/energy.h"
#include "physics/model/lattice/stages.h"
#include "physics/step/threads.h"
#include "weft/random.h"
#include "weft/simulation.h"

namespace weft::physics {
namespace {

constexpr double kDt = 1e-3;

struct Sheet {
  Scene scene;
  std::vector<Stencil> stencils;
  Lattice lattice;
};

// A crumpled sheet with one stencil, pinned in a few places.
Sheet crumpled(int nx, int ny, Stencil stencil, double gradient = 0) {
  Cloth cloth;
  cloth.grid.nx = nx;
  cloth.grid.ny = ny;
  cloth.stiffness_gradient = gradient;
  cloth.pins = {{0, 0, {}}, {nx - 1, 0, {}}, {nx / 2, ny / 2, {}}};
  Sheet s{{}, {}, make_lattice(cloth, 0, 1, true)};
  s.scene.solver.method = Method::compliant;
  s.scene.cloths.push_back(cloth);
  const double hu = 1.0 / (nx - 1), hv = 1.0 / (ny - 1);
  stencil.rest = std::hypot(stencil.di * hu, stencil.dj * hv);
  s.stencils = {stencil};
  Random random(5, 1);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) s.lattice.x.at(k, j, i) += float(0.2 * hu * random.symmetric());
  return s;
}

void sweep(Sheet& s, Simd simd, const LineOptions& options, int threads = 1) {
  const KernelTable& kernels = kernel_table(simd);
  const auto model = make_model(s.scene, 0, s.scene.solver.method, 1, kernels);
  const LatticeParts parts{
      {s.scene, s.scene.cloths[0], s.scene.solver.method, s.lattice, kernels, *model},
      s.lattice,
      s.stencils};
  Threads pool(threads);
  Rows corrections(s.lattice.rows, s.lattice.stride);
  make_line(parts, corrections, options)->run_alone(s.lattice.rows, {kDt, kDt, 0}, pool);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < s.lattice.rows; ++j)
      for (int i = 0; i < s.lattice.columns; ++i)
        s.lattice.x.at(k, j, i) += corrections.at(k, j, i);
}

// The Newton step of all constraints of the stencil at once: A μ = C by Gaussian elimination.
std::vector<Vec3> dense_step(const Sheet& s) {
  const Cloth& cloth = s.scene.cloths[0];
  std::vector<Vec3> x = s.lattice.gather(s.lattice.x);
  struct Constraint {
    int a, b;
    double alpha, violation;
    Vec3 n;
  };
  std::vector<Constraint> all;
  for_each_constraint(cloth, s.stencils[0], [&](int a, int b, double k) {
    Constraint c{a, b, 1 / (k * kDt * kDt), 0, {}};
    double squared = 0;
    for (int d = 0; d < 3; ++d) squared += (x[b][d] - x[a][d]) * (x[b][d] - x[a][d]);
    const double length = std::sqrt(squared);
    for (int d = 0; d < 3; ++d) c.n[d] = (x[b][d] - x[a][d]) / length;
    c.violation = length - s.stencils[0].rest;
    all.push_back(c);
  });
  const auto w = [&](int p) { return double(s.lattice.w(p / cloth.grid.nx, p % cloth.grid.nx)); };
  const std::size_t n = all.size();
  std::vector<std::vector<double>> m(n, std::vector<double>(n + 1));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const Constraint &p = all[i], &q = all[j];
      const double along = p.n[0] * q.n[0] + p.n[1] * q.n[1] + p.n[2] * q.n[2];
      for (const auto& [u, su] : {std::pair(p.a, -1.0), std::pair(p.b, 1.0)})
        for (const auto& [v, sv] : {std::pair(q.a, -1.0), std::pair(q.b, 1.0)})
          if (u == v) m[i][j] += w(u) * su * sv * along;
    }
    m[i][i] += all[i].alpha;
    m[i][n] = all[i].violation;
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t r = i + 1; r < n; ++r) {
      const double f = m[r][i] / m[i][i];
      if (f == 0) continue;
      for (std::size_t c = i; c <= n; ++c) m[r][c] -= f * m[i][c];
    }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t c = i + 1; c < n; ++c) m[i][n] -= m[i][c] * m[c][n];
    m[i][n] /= m[i][i];
    for (int d = 0; d < 3; ++d) {
      x[all[i].a][d] += w(all[i].a) * m[i][n] * all[i].n[d];
      x[all[i].b][d] -= w(all[i].b) * m[i][n] * all[i].n[d];
    }
  }
  return x;
}

struct Offset {
  int di, dj;
};
const Offset kOffsets[] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {2, 0},  {0, 2},
                           {3, 0}, {0, 3}, {3, 3}, {-2, 2}, {-3, 3}, {2, 2}};

TEST(LineSweep, SolvesEveryLineAsADenseSolverDoes) {
  for (const Offset o : kOffsets)
    for (const auto& [nx, ny] : {std::pair(19, 9), std::pair(9, 19), std::pair(36, 5)}) {
      Sheet s = crumpled(nx, ny, {o.di, o.dj, Kind::structural, 0, 2000, 0}, 0.5);
      const std::vector<Vec3> expected = dense_step(s);
      sweep(s, Simd::best, {true, 1, 1});
      const std::vector<Vec3> got = s.lattice.gather(s.lattice.x);
      double worst = 0;
      for (std::size_t p = 0; p < got.size(); ++p)
        for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(got[p][k] - expected[p][k]));
      EXPECT_LT(worst, 2e-6) << o.di << "," << o.dj << " on " << nx << " x " << ny;
    }
}

TEST(LineSweep, GivesTheSameBitsAtEveryWidthAndThreadCount) {
  for (const Offset o : kOffsets)
    for (const int iterations : {1, 3})
      for (const int n : {17, 70}) {
        const Stencil stencil{o.di, o.dj, Kind::structural, 0, 2000, 0};
        Sheet scalar = crumpled(n, n + 9, stencil, 0.3);
        sweep(scalar, Simd::scalar, {true, iterations, 1});
        for (const Simd simd : {Simd::sse2, Simd::avx2, Simd::avx512}) {
          if (!simd_available(simd)) continue;
          Sheet wide = crumpled(n, n + 9, stencil, 0.3);
          sweep(wide, simd, {true, iterations, 1}, 3);
          for (int j = 0; j < n + 9; ++j)
            for (int k = 0; k < 3; ++k)
              ASSERT_EQ(0, std::memcmp(&scalar.lattice.x.at(k, j, 0), &wide.lattice.x.at(k, j, 0),
                                       std::size_t(n) * sizeof(float)))
                  << simd_name(simd) << " " << o.di << "," << o.dj << " row " << j;
        }
      }
}

TEST(LineSweep, SweepsWithMultipliersConvergeToTheCompliantSolution) {
  // A chain at rest under its weight: with many sweeps one large substep is an implicit Euler step,
  // whatever the number of stencils; its elongation settles at m g n(n+1)/2k.
  Scene scene;
  scene.solver.method = Method::compliant;
  scene.solver.sweep = Sweep::line;
  scene.solver.iterations = 4;
  scene.time.substeps = 4;
  Cloth cloth;
  cloth.grid = {2, 11, {0, 0, 0}, {0.1, 0, 0}, {0, -1, 0}, 0};
  cloth.particle_mass = 0.01;
  cloth.stiffness = {500, 0, 0};
  cloth.drag = 8;
  cloth.pins = {{0, 0, {}}, {1, 0, {}}};
  scene.cloths.push_back(cloth);
  Simulation simulation(scene);
  for (int f = 0; f < 300; ++f) simulation.advance_frame();
  const double expected = 0.01 * 9.81 * 10 * 11 / (2 * 500);
  EXPECT_NEAR(-simulation.positions()[3 * 20 + 1] - 1, expected, 1e-3 * expected);
}

TEST(LineSweep, ACutFreePairOfPinsKeepsItsPlace) {
  // Rigid chains between two pins are one constraint over-determined: still finite and still.
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.solver.method = Method::positional;
  scene.solver.sweep = Sweep::line;
  scene.time.substeps = 4;
  Cloth cloth;
  cloth.grid.nx = cloth.grid.ny = 24;
  cloth.pins = {{0, 0, {}}, {23, 0, {}}, {0, 23, {}}, {23, 23, {}}};
  scene.cloths.push_back(cloth);
  Simulation simulation(scene);
  const std::vector<double> before = simulation.positions();
  for (int f = 0; f < 60; ++f) simulation.advance_frame();
  ASSERT_TRUE(simulation.status().ok) << simulation.status().text;
  const std::vector<double> after = simulation.positions();
  for (std::size_t c = 0; c < after.size(); ++c) EXPECT_NEAR(after[c], before[c], 1e-4);
}

}  // namespace
}  // namespace weft::physics
