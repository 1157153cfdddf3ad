// Seed 000's own meanings: levels with one diagonal, iterations that add spring forces again, and tears
// that take particles with them, against a solver in double precision and by counting.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

using Vec = std::array<double, 3>;

struct Case {
  int nx, ny, level, iterations, threads;
  LevelDiagonals diagonals;
  bool damped, repeat;
};

Scene curtain(const Case& c) {
  Scene scene;
  scene.time = {1.0 / 60, 12, 1};
  scene.solver.method = c.damped ? Method::spring_friction : Method::spring;
  scene.solver.iterations = c.iterations;
  scene.solver.iterate_springs = c.repeat;
  scene.solver.full_first_kick = true;
  Cloth cloth;
  cloth.grid.nx = c.nx;
  cloth.grid.ny = c.ny;
  cloth.grid.u = {0.15 * (c.nx - 1), 0, 0};
  cloth.grid.v = {0, -0.1 * (c.ny - 1), 0.05 * (c.ny - 1)};
  cloth.particle_mass = 0.1;
  cloth.stiffness = {15, 0, 0};
  cloth.spring_damping = {0.1, 0, 0};
  cloth.level = c.level;
  cloth.level_diagonals = c.diagonals;
  cloth.drag = 1.2;
  for (int i = 0; i < c.nx; ++i)
    if (i < 3 || i >= c.nx - 2) cloth.pins.push_back({i, 0, {}});
  scene.cloths.push_back(cloth);
  return scene;
}

// Position Verlet with Hooke's law and damping along the spring, every iteration adding them again.
class Plain {
 public:
  Plain(const Scene& scene, bool repeat, bool damped)
      : scene_(scene), c_(scene_.cloths[0]), repeat_(repeat), damped_(damped) {
    for (int j = 0; j < c_.grid.ny; ++j)
      for (int i = 0; i < c_.grid.nx; ++i)
        x.push_back({c_.grid.u[0] * i / (c_.grid.nx - 1), c_.grid.v[1] * j / (c_.grid.ny - 1),
                     c_.grid.v[2] * j / (c_.grid.ny - 1)});
    old_ = x;
    held_.assign(x.size(), false);
    for (const Pin& p : c_.pins) held_[at(p.i, p.j)] = true;
  }
  void advance(double seconds) {
    const double dt = scene_.time.frame / scene_.time.substeps;
    for (int n = 0; n < int(std::lround(seconds / dt)); ++n) step(dt);
  }
  std::vector<Vec> x;

 private:
  std::size_t at(int i, int j) const { return std::size_t(j * c_.grid.nx + i); }
  void spring(std::size_t a, std::size_t b, double rest, double dt) {
    Vec d, v;
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      d[k] = x[b][k] - x[a][k];
      v[k] = (x[b][k] - old_[b][k] - x[a][k] + old_[a][k]) / dt;
      square += d[k] * d[k];
    }
    const double length = std::sqrt(square);
    double along = 0;
    for (std::size_t k = 0; k < 3; ++k) along += d[k] / length * v[k];
    const double f = c_.stiffness.structural * (length - rest) +
                     (damped_ ? c_.spring_damping.structural * along : 0);
    for (std::size_t k = 0; k < 3; ++k) {
      force_[a][k] += f * d[k] / length;
      force_[b][k] -= f * d[k] / length;
    }
  }
  void step(double dt) {
    force_.assign(x.size(), {0, scene_.gravity[1] * c_.particle_mass, 0});
    const double su = spacing_u(c_.grid), sv = spacing_v(c_.grid);
    const auto join = [&](int i, int j, int oi, int oj, double rest) {
      if (oi >= 0 && oi < c_.grid.nx && oj < c_.grid.ny) spring(at(i, j), at(oi, oj), rest, dt);
    };
    for (int n = 0; n < (repeat_ ? scene_.solver.iterations : 1); ++n)
      for (int j = 0; j < c_.grid.ny; ++j)
        for (int i = 0; i < c_.grid.nx; ++i)
          for (int l = 1; l <= c_.level; ++l) {
            join(i, j, i + l, j, l * su);
            join(i, j, i, j + l, l * sv);
            join(i, j, i + l, j + l, l * std::hypot(su, sv));
            if (c_.level_diagonals == LevelDiagonals::both)
              join(i, j, i - l, j + l, l * std::hypot(su, sv));
          }
    for (std::size_t p = 0; p < x.size(); ++p) {
      if (held_[p]) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const double now = x[p][k];
        x[p][k] +=
            (1 - c_.drag * dt) * (now - old_[p][k]) + dt * dt * force_[p][k] / c_.particle_mass;
        old_[p][k] = now;
      }
    }
  }

  Scene scene_;
  const Cloth& c_;
  bool repeat_, damped_;
  std::vector<Vec> old_, force_;
  std::vector<bool> held_;
};

TEST(Levels, AreTheSeedsInDoublePrecision) {
  const auto both = LevelDiagonals::both, one = LevelDiagonals::one;
  for (const Case& c :
       {Case{12, 9, 2, 10, 1, one, false, true}, Case{9, 14, 1, 5, 2, one, true, true},
        Case{17, 8, 3, 2, 2, one, true, true}, Case{8, 8, 2, 10, 3, both, false, true},
        Case{11, 13, 2, 7, 1, one, false, false}, Case{10, 10, 4, 3, 2, both, true, false}}) {
    const Scene scene = curtain(c);
    Simulation simulation(scene, {.threads = c.threads});
    Plain truth(scene, c.repeat, c.damped);
    while (simulation.time() < 1 - 1e-9) simulation.advance_frame();
    truth.advance(1);
    ASSERT_EQ(simulation.substeps(), 12);
    const std::vector<double> x = simulation.positions();
    double most = 0;
    for (std::size_t p = 0; p < truth.x.size(); ++p)
      for (std::size_t k = 0; k < 3; ++k)
        most = std::max(most, std::abs(truth.x[p][k] - x[3 * p + k]));
    EXPECT_LT(most, 1e-4) << c.nx << " x " << c.ny << " level " << c.level;
  }
}

// One diagonal fewer for every method and sweep: their plans count the constraints.
TEST(Levels, OneDiagonalLeavesTheOtherOut) {
  for (const Method method :
       {Method::positional, Method::spring, Method::spring_friction, Method::compliant})
    for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::jacobi, Sweep::line}) {
      const bool springs = method == Method::spring || method == Method::spring_friction;
      if (springs && sweep != Sweep::gauss_seidel) continue;
      Scene scene = curtain({9, 7, 2, 1, 1, LevelDiagonals::one, false, false});
      scene.solver.method = method;
      scene.solver.sweep = sweep;
      Simulation simulation(scene, {.threads = 2});
      const Report r = simulation.report();
      EXPECT_EQ(r.constraints.structural, 8 * 7 + 9 * 6) << int(method) << int(sweep);
      EXPECT_EQ(r.constraints.shear, 8 * 6);
      EXPECT_EQ(r.constraints.bend, 7 * 7 + 9 * 5 + 7 * 5);
      for (int n = 0; n < 30; ++n) simulation.advance_frame();
      EXPECT_TRUE(simulation.status().ok);
    }
}

bool tells_of_iterations(const Scene& scene) {
  const Simulation simulation(scene, {.threads = 1});
  const auto& notes = simulation.plan().notes;
  return std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("springs have no iterations") != std::string::npos;
  });
}

TEST(Levels, IterationsThatDoNothingAreTold) {
  Scene scene = curtain({9, 7, 0, 10, 1, LevelDiagonals::both, false, false});
  scene.cloths[0].level = 0;
  EXPECT_TRUE(tells_of_iterations(scene));
  scene.solver.iterations = 1;
  EXPECT_FALSE(tells_of_iterations(scene));
  scene.solver.iterations = 10;
  scene.solver.iterate_springs = true;
  EXPECT_FALSE(tells_of_iterations(scene));
  scene.solver.iterate_springs = false;
  scene.solver.method = Method::compliant;
  EXPECT_FALSE(tells_of_iterations(scene));
}

// Ten iterations of K are one of ten times K: the same bits, the same limit of the substep.
TEST(Levels, RepeatedSpringsAreStifferSprings) {
  for (const bool damped : {false, true}) {
    Scene repeated = curtain({10, 12, 2, 8, 1, LevelDiagonals::one, damped, true});
    repeated.time.substeps = kAutoSubsteps;
    Scene stiffer = repeated;
    stiffer.solver.iterations = 1;
    stiffer.cloths[0].stiffness.structural *= 8;
    stiffer.cloths[0].spring_damping.structural *= 8;
    Simulation a(repeated, {.threads = 1}), b(stiffer, {.threads = 2});
    EXPECT_EQ(a.substeps(), b.substeps());
    for (int n = 0; n < 40; ++n) a.advance_frame(), b.advance_frame();
    EXPECT_EQ(a.hash(), b.hash());
    EXPECT_EQ(a.report().energy.elastic, b.report().energy.elastic);
  }
}

// A curtain with a ball that stretches it.
Scene torn(const std::string& method, double tear_strain, bool by_touch) {
  const std::string cuts = by_touch ? "true" : "false", strain = std::to_string(tear_strain);
  return read_scene("seed3_" + method,
                    {{"/cloths/0/tear_strain", strain}, {"/colliders/0/cuts", cuts}})
      .scene;
}

// Everything that the seed says of a hole: particles that lose one constraint by its length lose all, and
// their triangles are gone; others keep theirs.
void expect_whole_particles(const Simulation& simulation) {
  const Snapshot snapshot = simulation.snapshot();
  const Cloth& cloth = simulation.scene().cloths[0];
  const int nx = cloth.grid.nx, ny = cloth.grid.ny;
  std::set<std::pair<int, int>> free;  // by counting constraints
  std::vector<int> lost(std::size_t(nx * ny)), had = lost;
  const auto count = [&](int i, int j, std::vector<int>& of) { ++of[std::size_t(j * nx + i)]; };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      for (int n = 1; n <= cloth.level; ++n)
        for (const auto& [di, dj] : {std::pair{n, 0}, {0, n}, {n, n}})
          if (i + di < nx && j + dj < ny) count(i, j, had), count(i + di, j + dj, had);
  for (const auto& [a, b] : snapshot.cloths[0].torn) {
    ++lost[std::size_t(a)];
    ++lost[std::size_t(b)];
  }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const auto p = std::size_t(j * nx + i);
      if (lost[p] == had[p]) free.insert({i, j});
    }
  for (const auto& [a, b] : snapshot.cloths[0].torn)
    EXPECT_TRUE(free.count({a % nx, a / nx}) || free.count({b % nx, b / nx}));
  const ClothView view = simulation.view().cloths[0];
  std::set<std::uint32_t> drawn;
  for (const auto& triangle : view.triangles) drawn.insert(triangle.begin(), triangle.end());
  for (const auto& [i, j] : free) EXPECT_FALSE(drawn.count(std::uint32_t(j * view.stride + i)));
  EXPECT_TRUE(view.tear_triangles.empty());
}

// The sphere is as fast for every cut length; what it stretches past that goes, and no more.
TEST(CutLength, DecidesWhatASphereTearsOut) {
  for (const auto& [method, shipped] :
       {std::pair{"positional", 1.0}, {"spring", 2.0}, {"friction", 4.0}})
    for (const double strain : {0.8 * shipped, shipped, 1.5 * shipped, 20.0}) {
      Simulation simulation(torn(method, strain, false), {.threads = 2});
      while (simulation.time() < 3) simulation.advance_frame();
      const std::int64_t torn = simulation.report().torn;
      if (strain == 20) {
        EXPECT_EQ(torn, 0) << method;
      } else if (strain == shipped) {
        EXPECT_GT(torn, 20) << method;
      }
      expect_whole_particles(simulation);
    }
}

TEST(CutLength, ParticlesAreTheSameByTouchInAnyOrderAndFromASnapshot) {
  const Scene scene = torn("spring", 20, true);
  Simulation a(scene, {.threads = 1}), b(scene, {.threads = 3, .simd = Simd::scalar});
  while (a.time() < 3) a.advance_frame();
  while (b.time() < 3) b.advance_frame();
  EXPECT_EQ(a.hash(), b.hash());
  const std::int64_t gone = a.report().torn;
  EXPECT_GT(gone, 100);
  expect_whole_particles(a);
  Simulation c(scene, {.threads = 2});
  c.restore(a.snapshot());
  EXPECT_EQ(c.report().torn, gone);
  const auto same = [](const ClothView& x, const ClothView& y) {
    return std::equal(x.triangles.begin(), x.triangles.end(), y.triangles.begin(),
                      y.triangles.end());
  };
  EXPECT_TRUE(same(a.view().cloths[0], c.view().cloths[0]));
  for (int n = 0; n < 30; ++n) a.advance_frame(), c.advance_frame();
  EXPECT_EQ(a.report().torn, c.report().torn);
  EXPECT_TRUE(same(a.view().cloths[0], c.view().cloths[0]));
}

}  // namespace
}  // namespace weft
