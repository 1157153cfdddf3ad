// A second model beside the grid: a bundle of chains, whose links are distance constraints. It runs
// through stages, wavefront, colliders, sleeping, snapshots, report and hash, and no file of the grid's
// knows of it.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/frame/measure.h"
#include "physics/frame/state.h"

namespace weft::physics {
namespace {

constexpr double kLink = 0.01;  // m

// Strand i of a bundle has a particle in row j as long as it reaches: every third ends half way.
int strands_in(int row, int rows, int strands) {
  return row < rows / 2 ? strands : strands - strands / 3;
}

// v += g dt, x += v dt.
class Fall final : public RowStage {
 public:
  explicit Fall(const ClothParts& parts)
      : RowStage("fall", "gravity", 0, parts.particles.count(), "particles"), parts_(parts) {}
  bool moves_particles() const override { return true; }
  using RowStage::run;
  void run(int j, const Substep& s) override {
    Particles& p = parts_.particles;
    for (int i = 0; i < p.count(j); ++i)
      for (int k = 0; k < 3 && p.w(j, i) > 0; ++k) {
        float &x = p.x.at(k, j, i), &v = p.v.at(k, j, i);
        v = float(v + parts_.scene.gravity[std::size_t(k)] * s.dt);
        x = coordinate(x + v * s.dt);
      }
  }

 private:
  ClothParts parts_;
};

// Links between rows j and j+1 are put back to their length, row after row.
class Links final : public RowStage {
 public:
  explicit Links(const ClothParts& parts)
      : RowStage("links", "distances", 1, parts.particles.count(), "constraints"), parts_(parts) {}
  using RowStage::run;
  void run(int j, const Substep& s) override {
    Particles& p = parts_.particles;
    for (int i = 0; j + 1 < p.rows && i < p.count(j + 1); ++i) {
      const double w = p.w(j, i), u = p.w(j + 1, i);
      const Vec3 a = p.position(j, i), b = p.position(j + 1, i);
      const Vec3 e{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
      const double length = std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
      if (length == 0 || w + u == 0) continue;
      for (int k = 0; k < 3; ++k) {
        const double by = (length - kLink) / length / (w + u) * e[std::size_t(k)];
        move(p, k, j, i, by * w, s.dt);
        move(p, k, j + 1, i, -by * u, s.dt);
      }
    }
  }

 private:
  static void move(Particles& p, int k, int j, int i, double by, double dt) {
    p.x.at(k, j, i) = coordinate(p.x.at(k, j, i) + by);
    p.v.at(k, j, i) = float(p.v.at(k, j, i) + by / dt);
  }
  ClothParts parts_;
};

// Strands side by side along x, hanging from the first row.
class Bundle final : public ClothModel {
 public:
  Bundle(const Scene& scene, int index, Method method, const KernelTable& kernels)
      : method_(method),
        particles_(counts_of(scene.cloths[std::size_t(index)].grid), false),
        parts_{scene, scene.cloths[std::size_t(index)], method_, particles_, kernels, *this} {
    const Grid& g = parts_.cloth.grid;
    particles_.for_each([&](int j, int i) {
      particles_.x.at(0, j, i) = float(g.origin[0] + i * kLink);
      particles_.x.at(1, j, i) = float(g.origin[1] - j * kLink);
      particles_.w(j)[i] = float(1 / mass(0));
    });
    for (const Pin& pin : parts_.cloth.pins) particles_.w(pin.j)[pin.i] = 0;
    for (int j = 0; j < particles_.rows; ++j) particles_.weigh_row(j);
  }

  const ClothParts& parts() const override { return parts_; }
  void append_motion(Method, StageList& list) override {
    list.stages.push_back(std::make_unique<Fall>(parts_));
    list.stages.push_back(std::make_unique<Links>(parts_));
    list.skip("springs", "links are distances");
  }
  void append_limits(StageList&) override {}
  double mass(int) const override { return parts_.cloth.particle_mass; }
  const SurfaceMesh& surface() const override { return surface_; }
  ConstraintCounts constraints() const override {
    return {particles_.count() - particles_.count(0), 0, 0};
  }
  Pull pull() const override { return {}; }
  void accelerations(const Vec3& gravity, std::vector<Vec3>& a) const override {
    a.assign(std::size_t(particles_.count()), gravity);
  }
  ElasticEnergy elastic_energy() const override { return {}; }
  Strain strain() const override {
    Strain strain;
    const Particles& p = particles_;
    p.for_each([&](int j, int i) {
      if (j == 0) return;
      const Vec3 a = p.position(j - 1, i), b = p.position(j, i);
      const double length = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
      strain.max = std::max(strain.max, length / kLink - 1);
      strain.mean += length / kLink - 1;
      ++strain.constraints;
    });
    strain.mean /= double(strain.constraints);
    return strain;
  }
  double limited_strain() const override { return strain().max; }
  Vec3 pin_position(const Pin& pin, double) const override {
    return particles_.position(pin.j, pin.i);
  }
  double held_energy(const Rows&, double, Threads&) const override { return 0; }
  float greatest_stretch(const Rows&) const override { return 1; }
  double strain_in_line(const Rows&, double) const override { return 0; }
  double attachment_energy(const Rows&, double) const override { return 0; }
  double rounding_gain() const override { return 0; }
  Spectrum find_spectrum(std::span<const float>) const override { return {}; }
  bool folds_freely() const override { return false; }
  double stiffening(double stretch) const override { return stiffening_of_springs(stretch); }
  std::vector<Joined> constraints_near(const Vec3&, const Vec3&, double) const override {
    return {};
  }
  std::size_t bytes() const override { return particles_.bytes(); }

 private:
  static std::vector<int> counts_of(const Grid& g) {
    std::vector<int> counts;
    for (int j = 0; j < g.ny; ++j) counts.push_back(strands_in(j, g.ny, g.nx));
    return counts;
  }

  const Method method_;
  Particles particles_;
  const ClothParts parts_;
  SurfaceMesh surface_;
};

std::unique_ptr<ClothModel> make_bundle(const Scene& scene, int index, Method method, std::uint64_t,
                                        const KernelTable& kernels) {
  return std::make_unique<Bundle>(scene, index, method, kernels);
}

Scene hanging(int strands, int rows) {
  Scene scene;
  scene.solver.method = Method::compliant;
  scene.time.substeps = 40;
  Cloth cloth;
  cloth.grid = {strands, rows, {0, 0, 0}, {1, 0, 0}, {0, -1, 0}, 0};
  cloth.particle_mass = 1e-3;
  for (int i = 0; i < strands; ++i) cloth.pins.push_back({i, 0, {}});
  scene.cloths.push_back(cloth);
  return scene;
}

struct Bundled {
  Bundled(const Scene& scene, const Options& options) : state(scene, options, {}, make_bundle) {}
  void advance(int frames) {
    for (int n = 0; n < frames; ++n) state.advance_frame();
    ASSERT_TRUE(state.status.ok) << state.status.text;
  }
  Simulation::State state;
};

TEST(Chain, HangsAtItsLengthAndIsReported) {
  Bundled run(hanging(12, 40), {.threads = 1});
  run.advance(60);
  const Report report = measure(run.state, true);
  const int particles = 20 * 12 + 20 * 8;
  EXPECT_EQ(report.particles, particles);
  EXPECT_EQ(report.constraints.structural, particles - 12);
  EXPECT_LT(report.strain.max, 0.02);
  EXPECT_EQ(report.stages[0].name, "step");
  EXPECT_EQ(run.state.plan.stages[1].name, "links");
  EXPECT_EQ(run.state.plan.skipped[0].why, "links are distances");
  double gravity = 0;  // of straight strands
  for (int j = 0; j < 40; ++j) gravity -= 1e-3 * 9.81 * j * kLink * strands_in(j, 40, 12);
  EXPECT_NEAR(report.energy.gravity, gravity, 0.02 * std::abs(gravity));
}

TEST(Chain, FallsFreelyWithoutItsPins) {
  Scene scene = hanging(6, 30);
  scene.cloths[0].pins.clear();
  Bundled run(scene, {.threads = 1});
  run.advance(30);
  const Report report = measure(run.state, true);
  EXPECT_NEAR(report.momentum[1] / (double(report.particles) * 1e-3), -9.81 * 0.5, 1e-3);
  EXPECT_LT(report.strain.max, 1e-3);
}

// A ball swings the strands aside; threads and instruction sets change no bit.
TEST(Chain, MeetsCollidersAndIsTheSameOnAnyThreads) {
  Scene scene = hanging(300, 100);
  scene.colliders.push_back({.shape = Sphere{{1.5, -0.5, 0}, 0.3}, .friction = {}, .keys = {}});
  scene.colliders[0].keys = {{0, {1.5, -0.5, -0.5}}, {0.16, {1.5, -0.5, 0.1}}};
  std::uint64_t hash = 0;
  for (const int threads : {1, 2, 3, 8})
    for (const Simd simd : {Simd::scalar, Simd::best}) {
      if (threads > 1 && simd == Simd::scalar) continue;
      Bundled run(scene, {.threads = threads, .simd = simd});
      run.advance(10);
      const Report report = measure(run.state, true);
      EXPECT_LT(report.penetration.collider_max, 1e-4);
      EXPECT_GT(report.momentum[2], 1e-3);
      if (hash == 0) hash = report.hash;
      EXPECT_EQ(report.hash, hash) << threads << " threads, " << simd_name(simd);
    }
}

TEST(Chain, GoesBackToASnapshotAndTakesAHand) {
  Bundled run(hanging(12, 40), {.threads = 1});
  run.advance(5);
  const Snapshot start = run.state.snapshot();
  EXPECT_EQ(start.cloths[0].held.size(), 12u);
  const int end = run.state.cloths[0]->particles().count() - 1;
  run.state.grab(0, end, {0.2, -0.2, 0.2}, 100);
  run.advance(20);
  const Vec3 pulled = run.state.cloths[0]->particles().position(39, 7);
  EXPECT_GT(pulled[2], 0.05);
  run.state.release();
  run.state.hold(0, end, true);
  run.advance(10);
  EXPECT_EQ(run.state.cloths[0]->particles().position(39, 7), pulled);
  run.state.check(start);
  run.state.restore(start);
  EXPECT_EQ(run.state.frame, 5);
  EXPECT_EQ(run.state.snapshot().cloths[0].positions, start.cloths[0].positions);
  EXPECT_THROW(run.state.hold(0, end + 1, true), std::out_of_range);
}

TEST(Chain, ComesToRestOnAPlane) {
  Scene scene = hanging(12, 40);
  scene.cloths[0].pins.clear();
  scene.solver.sleep = 0.02;
  scene.gravity = {0, -9.81, 0};
  scene.colliders.push_back({.shape = Plane{{0, -0.5, 0}, {0, 1, 0}},
                             .friction = {FrictionModel::coulomb, 0.9, 0.8},
                             .keys = {}});
  Bundled run(scene, {.threads = 1});
  run.advance(600);
  EXPECT_LT(measure(run.state, true).penetration.collider_max, 1e-4);
  EXPECT_GT(measure(run.state, true).asleep, 0);
}

}  // namespace
}  // namespace weft::physics
