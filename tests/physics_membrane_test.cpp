// The membrane: against its energy in double precision, written from the formulas alone; its stresses in
// closed form; what is kept; the same bits everywhere.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "double_vector.h"
#include "machines.h"
#include "truth.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

using oracle::dot;
using oracle::operator+;
using oracle::operator-;
using oracle::operator*;
using Vectors = std::vector<Vec3>;

Scene sheet(int nx, int ny, const Vec3& u, const Vec3& v, const Membrane& membrane) {
  Scene scene;
  scene.time.frame = 1.0 / 64;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.grid = {nx, ny, {0.1, 0.2, 0.3}, u, v, 0};
  cloth.membrane = membrane;
  return scene;
}

Vectors vectors(const std::vector<double>& values) {
  Vectors all;
  for (std::size_t n = 0; n < values.size(); n += 3)
    all.push_back({values[n], values[n + 1], values[n + 2]});
  return all;
}
std::vector<double> values(const Vectors& all) {
  std::vector<double> list;
  for (const Vec3& v : all) list.insert(list.end(), v.begin(), v.end());
  return list;
}

// The sheet in the words of the paper: cells with means of their edges, a = x10 - x00 and so on.
class Sheet {
 public:
  explicit Sheet(const Scene& scene) : scene_(scene), cloth_(scene.cloths[0]) {}

  // Force on every particle by forward differentiation of the energy of each cell.
  Vectors forces(const Vectors& x, const Vectors& v) const {
    const Grid& g = cloth_.grid;
    Vectors f(x.size(), Vec3{});
    for (int j = 0; j + 1 < g.ny; ++j)
      for (int i = 0; i + 1 < g.nx; ++i) add_cell(x, v, j * g.nx + i, j, f);
    const Bending& d = cloth_.bending;
    const double hu = oracle::length(g.u) / (g.nx - 1), hv = oracle::length(g.v) / (g.ny - 1);
    // A line of particles stands for the spacing of lines, on the border for half of it, or all share the sheet.
    const bool by_area = lumps_by_area(cloth_);
    const auto width = [&](int line, int lines) {
      return !by_area ? (lines - 1.0) / lines : line == 0 || line == lines - 1 ? 0.5 : 1;
    };
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const int p = j * g.nx + i;
        if (i + 2 < g.nx)
          add_bend(x, v, {p, p + 1, p + 2}, {1, -2, 1},
                   d.warp * width(j, g.ny) * hv / (hu * hu * hu), f);
        if (j + 2 < g.ny)
          add_bend(x, v, {p, p + g.nx, p + 2 * g.nx}, {1, -2, 1},
                   d.weft * width(i, g.nx) * hu / (hv * hv * hv), f);
        if (i + 1 < g.nx && j + 1 < g.ny)
          add_bend(x, v, {p, p + 1, p + g.nx, p + g.nx + 1}, {1, -1, -1, 1},
                   2 * d.twist / (hu * hv), f);
      }
    return f;
  }
  double mass(int p) const { return particle_mass(cloth_, p % cloth_.grid.nx, p / cloth_.grid.nx); }
  int particles() const { return cloth_.grid.nx * cloth_.grid.ny; }

  void substep(Vectors& x, Vectors& v, double dt) const {
    const Vectors f = forces(x, v);
    for (int p = 0; p < particles(); ++p) {
      bool held = false;
      for (const Pin& pin : cloth_.pins) held |= pin.j * cloth_.grid.nx + pin.i == p;
      if (held) continue;
      const auto n = std::size_t(p);
      v[n] = (1 - dt * cloth_.drag) * v[n] + dt * ((1 / mass(p)) * f[n] + scene_.gravity);
      x[n] = x[n] + dt * v[n];
    }
  }

 private:
  // Of the energy k d²/2, d a sum of places with factors.
  void add_bend(const Vectors& x, const Vectors& v, const std::vector<int>& of,
                const std::vector<double>& factors, double k, Vectors& f) const {
    Vec3 d{};
    for (std::size_t n = 0; n < of.size(); ++n) {
      const auto p = std::size_t(of[n]);
      d = d + factors[n] * (x[p] + cloth_.bending.damping * v[p]);
    }
    for (std::size_t n = 0; n < of.size(); ++n) {
      Vec3& force = f[std::size_t(of[n])];
      force = force - k * factors[n] * d;
    }
  }

  void add_cell(const Vectors& x, const Vectors& v, int p, int j, Vectors& f) const {
    const Grid& g = cloth_.grid;
    const Membrane& m = cloth_.membrane;
    const double hu = oracle::length(g.u) / (g.nx - 1), hv = oracle::length(g.v) / (g.ny - 1);
    const std::size_t c[4] = {std::size_t(p), std::size_t(p + 1), std::size_t(p + g.nx),
                              std::size_t(p + g.nx + 1)};
    const Vec3 a0 = x[c[1]] - x[c[0]], a1 = x[c[3]] - x[c[2]];
    const Vec3 b0 = x[c[2]] - x[c[0]], b1 = x[c[3]] - x[c[1]];
    const Vec3 va0 = v[c[1]] - v[c[0]], va1 = v[c[3]] - v[c[2]];
    const Vec3 vb0 = v[c[2]] - v[c[0]], vb1 = v[c[3]] - v[c[1]];
    const Vec3 a = a0 + a1, b = b0 + b1, va = va0 + va1, vb = vb0 + vb1;
    const double area = hu * hv * (1 - cloth_.stiffness_gradient * (j + 0.5) / (g.ny - 1));
    const auto green = [&](const Vec3& e, const Vec3& rate, double h) {
      return (dot(e, e) / (h * h) - 1) / 2 + m.damping * dot(e, rate) / (h * h);
    };
    const double e0 = green(a0, va0, hu), e1 = green(a1, va1, hu);
    const double w0 = green(b0, vb0, hv), w1 = green(b1, vb1, hv);
    const double shear = (dot(a, b) + m.damping * (dot(va, b) + dot(a, vb))) / (4 * hu * hv);
    // dE/da and dE/db of each edge.
    const auto pull = [&](const Vec3& along, double stress, double h, const Vec3& other) {
      return (area * stress / (2 * h * h)) * along +
             (area * m.shear * shear / (4 * hu * hv)) * other;
    };
    const double across = m.coupling * (w0 + w1) / 2, along = m.coupling * (e0 + e1) / 2;
    const Vec3 fa0 = pull(a0, m.warp * e0 + across, hu, b),
               fa1 = pull(a1, m.warp * e1 + across, hu, b);
    const Vec3 fb0 = pull(b0, m.weft * w0 + along, hv, a),
               fb1 = pull(b1, m.weft * w1 + along, hv, a);
    f[c[0]] = f[c[0]] + fa0 + fb0;
    f[c[1]] = f[c[1]] - fa0 + fb1;
    f[c[2]] = f[c[2]] + fa1 - fb0;
    f[c[3]] = f[c[3]] - fa1 - fb1;
  }

  const Scene& scene_;
  const Cloth& cloth_;
};

TEST(Membrane, MovesAsItsEnergySaysInDoublePrecision) {
  std::mt19937 random(5);
  const auto between = [&](double a, double b) {
    return a + (b - a) * std::uniform_real_distribution<double>()(random);
  };
  const std::vector<Options> all = machines();
  for (int trial = 0; trial < 40; ++trial) {
    const int nx = 2 + int(between(0, 40)), ny = 2 + int(between(0, 12));
    Membrane m{between(100, 3000), between(100, 3000), 0, between(10, 90), 0};
    m.coupling = between(-0.9, 0.9) * std::sqrt(m.warp * m.weft);
    if (trial % 2 == 1) m.damping = between(1e-5, 1e-4);
    const double width = 0.02 * (nx - 1), turn = between(0, 6);
    Scene scene = sheet(nx, ny, {width * std::cos(turn), width * std::sin(turn), 0},
                        {0, 0, between(0.015, 0.03) * (ny - 1)}, m);
    scene.gravity = {between(-3, 3), -9, between(-3, 3)};
    scene.solver.full_first_kick = true;
    scene.time.substeps = 1024;
    Cloth& cloth = scene.cloths[0];
    cloth.spin = {between(-9, 9), between(-9, 9), between(-9, 9)};
    cloth.drag = trial % 3 == 0 ? 1 : 0;
    cloth.stiffness_gradient = trial % 4 == 0 ? 0.5 : 0;
    cloth.lumping = trial % 5 == 0 ? Lumping::equal : Lumping::area;
    if (trial % 4 >= 2) {
      cloth.bending = between(1e-5, 1e-3);
      if (trial % 8 >= 6) cloth.bending.weft = 0, cloth.bending.twist = between(0, 1e-3);
      if (trial % 3 == 2) cloth.bending.damping = between(1e-4, 2e-3);
    }
    if (trial % 3 != 1) cloth.pins = {{0, 0, {}}, {nx - 1, ny - 1, {}}};
    Simulation simulation(scene, all[std::size_t(trial) % all.size()]);
    const Sheet truth(scene);
    Vectors x = vectors(simulation.positions()), v = vectors(simulation.velocities());
    Vectors near = x,
            near_v = v;  // what comes of rounding the start alone, where a run rounds every substep
    for (Vec3& p : near)
      for (double& c : p) c += between(-1e-7, 1e-7);
    simulation.advance_frame();
    for (int s = 0; s < 1024; ++s) {
      truth.substep(x, v, scene.time.frame / 1024);
      truth.substep(near, near_v, scene.time.frame / 1024);
    }
    ASSERT_FALSE(simulation.plan().fallback) << trial;
    const Vectors now = vectors(simulation.positions());
    double worst = 0, rounding = 0;
    for (std::size_t p = 0; p < x.size(); ++p) {
      worst = std::max(worst, oracle::length(now[p] - x[p]));
      rounding = std::max(rounding, oracle::length(near[p] - x[p]));
    }
    EXPECT_LT(worst, 5e-6 + 16 * rounding) << trial << ": " << nx << " x " << ny;
  }
}

// A patch that is stretched and sheared evenly pulls at its sides by its first Piola stress F C E, whatever
// the way it lies in space, and its inside is at rest.
TEST(Membrane, HasTheStressOfTheContinuumInAnyOrientation) {
  const Membrane m{3000, 2000, 200, 80, 0};
  struct Case {
    const char* name;
    double uu, uv, vu, vv;  // the deformation gradient in the sheet's plane
  };
  for (const Case& f :
       {Case{"10 % along warp", 1.1, 0, 0, 1}, Case{"10 % along weft", 1, 0, 0, 1.1},
        Case{"5 % and 8 % along both", 1.05, 0, 0, 1.08}, Case{"simple shear of 0.1", 1, 0.1, 0, 1},
        Case{"at an angle to the threads", 1.03, 0.05, -0.02, 0.98}}) {
    double worst = 0;
    for (const double turn : {0.0, 0.7, 2.0}) {
      constexpr int nx = 9, ny = 7;
      constexpr double hu = 0.125, hv = 0.0625;
      Scene scene = sheet(nx, ny, {hu * (nx - 1), 0, 0}, {0, 0, hv * (ny - 1)}, m);
      scene.gravity = {};
      scene.cloths[0].grid.origin = {};
      scene.time.frame = 1e-5;
      scene.cloths[0].density = 30;
      scene.time.substeps = 1;
      Simulation simulation(scene);
      const Vec3 u = {std::cos(turn), std::sin(turn), 0},
                 w = {-0.6 * std::sin(turn), 0.6 * std::cos(turn), 0.8};
      Vectors x;
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
          x.push_back((f.uu * i * hu + f.uv * j * hv) * u + (f.vu * i * hu + f.vv * j * hv) * w);
      simulation.set_state(values(x), std::vector<double>(3 * x.size()));
      simulation.advance_frame();
      const Vectors v = vectors(simulation.velocities());
      const double e11 = (f.uu * f.uu + f.vu * f.vu - 1) / 2,
                   e22 = (f.uv * f.uv + f.vv * f.vv - 1) / 2;
      const double s11 = m.warp * e11 + m.coupling * e22, s22 = m.weft * e22 + m.coupling * e11;
      const double s12 = m.shear * (f.uu * f.uv + f.vu * f.vv);
      const Vec3 fu = f.uu * u + f.vu * w, fv = f.uv * u + f.vv * w;
      const Vec3 on_u = hv * (s11 * fu + s12 * fv), on_v = hu * (s12 * fu + s22 * fv);
      const auto force = [&](int i, int j) {
        return (particle_mass(scene.cloths[0], i, j) / scene.time.frame) *
               v[std::size_t(j * nx + i)];
      };
      const double scale = oracle::length(on_u) + oracle::length(on_v);
      for (const Vec3& off : {force(nx - 1, 3) + on_u, force(0, 2) - on_u, force(4, ny - 1) + on_v,
                              force(5, 0) - on_v, force(4, 3)})
        worst = std::max(worst, oracle::length(off) / scale);
    }
    expect({"stress of a woven membrane in a homogeneous deformation, any way it lies", f.name, 0,
            1e-4, "of it"},
           worst);
  }
}

struct Motion {
  Vec3 momentum{}, angular{};
};
Motion motion(const Simulation& simulation, const Scene& scene) {
  const Vectors x = vectors(simulation.positions()), v = vectors(simulation.velocities());
  Motion sum;
  for (std::size_t p = 0; p < x.size(); ++p) {
    const int nx = scene.cloths[0].grid.nx;
    const double m = particle_mass(scene.cloths[0], int(p) % nx, int(p) / nx);
    const Vec3 &r = x[p], w = m * v[p];
    sum.momentum = sum.momentum + w;
    sum.angular = sum.angular + Vec3{r[1] * w[2] - r[2] * w[1], r[2] * w[0] - r[0] * w[2],
                                     r[0] * w[1] - r[1] * w[0]};
  }
  return sum;
}

// Damping takes what vibrates, and nothing of a turn or of a flight.
TEST(Membrane, KeepsMomentumAndDampsNoTurn) {
  for (const double damping : {0.0, 2e-4}) {
    Scene scene = sheet(20, 14, {0.4, 0, 0}, {0, 0, 0.3}, {2000, 1500, 300, 60, damping});
    scene.gravity = {};
    Cloth& cloth = scene.cloths[0];
    cloth.bending = Bending(1e-4);
    cloth.bending.weft = 3e-4;
    cloth.bending.damping = 10 * damping;
    cloth.velocity = {0.5, -0.25, 1};
    cloth.spin = {3, 5, -4};
    Simulation simulation(scene);
    const Motion before = motion(simulation, scene);
    for (int frame = 0; frame < 64; ++frame) simulation.advance_frame();
    const Motion after = motion(simulation, scene);
    EXPECT_LT(oracle::length(after.momentum - before.momentum),
              1e-4 * oracle::length(before.momentum));
    EXPECT_LT(oracle::length(after.angular - before.angular),
              1e-3 * oracle::length(before.angular));
    EXPECT_TRUE(simulation.status().ok);
    EXPECT_FALSE(simulation.plan().fallback);
  }
}

TEST(Membrane, HasTheSameBitsEverywhereWhileItTears) {
  Scene scene = sheet(27, 19, {0.6, 0, 0}, {0, 0, 0.5}, {800, 900, -100, 60, 1e-5});
  Cloth& cloth = scene.cloths[0];
  cloth.bending = 1e-4;
  cloth.tear_strain = 0.15;
  cloth.pins = {{0, 0, {}}, {26, 0, {{0, {}}, {0.5, {0.2, 0.3, 0}}}}, {13, 18, {}}};
  cloth.density = 2;
  std::uint64_t first = 0;
  for (const Options& options : machines()) {
    Simulation simulation(scene, options);
    for (int frame = 0; frame < 10; ++frame) simulation.advance_frame();
    if (first == 0) first = simulation.hash();
    EXPECT_EQ(simulation.hash(), first) << simd_name(options.simd) << ' ' << options.threads;
    EXPECT_GT(simulation.report().torn, 0);
  }
}

// Springs on a grid have no damping of bending, which is no silence.
TEST(Membrane, AloneHasDampingOfBendingOnAGrid) {
  Scene scene = sheet(5, 5, {1, 0, 0}, {0, 0, 1}, {});
  scene.cloths[0].bending = 1e-5;
  scene.cloths[0].bending.damping = 0.5;
  const std::vector<Fault> faults = validate(scene);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].place, "/cloths/0/bending/damping");
  EXPECT_EQ(faults[0].allowed, "0 s, on a grid of springs");
  scene.cloths[0].membrane = {2000, 1500, 300, 60, 0};
  EXPECT_TRUE(validate(scene).empty());
}

// Below a cut from side to side nothing holds the sheet.
TEST(Membrane, FallsFreelyBelowACut) {
  Scene scene = sheet(16, 16, {0.3, 0, 0}, {0, -0.3, 0}, {1000, 1000, 200, 100, 0});
  for (int i = 0; i < 16; ++i) scene.cloths[0].pins.push_back({i, 0, {}});
  Simulation simulation(scene);
  ASSERT_GT(simulation.cut({0, 0.2 - 0.15, 0.3}, {0.6, 0.2 - 0.15, 0.3}, 1e-3), 0);
  const double before = simulation.positions()[3 * (15 * 16 + 8) + 1];
  for (int frame = 0; frame < 16; ++frame) simulation.advance_frame();
  const double t = 16.0 / 64, fallen = before - simulation.positions()[3 * (15 * 16 + 8) + 1];
  EXPECT_NEAR(fallen, 9.81 * t * t / 2, 1e-3);
}

// A state stretched 10⁴ times would take substeps of 10⁻⁹ s: no number of them resolves it.
TEST(Membrane, TakesNoMoreSubstepsThanSinglePrecisionResolves) {
  for (const int asked : {kAutoSubsteps, 50})
    for (const double stretch : {30.0, 1e3, 1e4}) {
      Scene scene = sheet(9, 7, {0.8, 0, 0}, {0, 0, 0.6}, {200, 150, 40, 30, 0.001});
      scene.time.substeps = asked;
      Simulation simulation(scene);
      std::vector<double> x = simulation.positions();
      for (double& value : x) value *= stretch;
      simulation.set_state(x, std::vector<double>(x.size()));
      EXPECT_GT(simulation.dt(), 1e-7) << stretch;
      for (int n = 0; n < 2; ++n) simulation.advance_frame();
      EXPECT_GT(simulation.dt(), 1e-8) << stretch;
      EXPECT_TRUE(simulation.plan().fallback || !simulation.status().ok) << stretch;
    }
}

TEST(Membrane, IsTakenForSpringsByMethodsThatProjectWhichANoteSays) {
  Scene scene = sheet(12, 12, {0.3, 0, 0}, {0, 0, 0.3}, {1000, 800, 200, 50, 0});
  scene.solver.method = Method::compliant;
  scene.solver.sweep = Sweep::jacobi;
  Simulation simulation(scene);
  bool told = false;
  for (const std::string& note : simulation.plan().notes)
    told |= note.find("springs of the membrane's warp") != std::string::npos &&
            note.find("by 50 N/m, not by 200") != std::string::npos;
  EXPECT_TRUE(told);
}

}  // namespace
}  // namespace weft
