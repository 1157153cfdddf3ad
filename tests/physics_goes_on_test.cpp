// A run that goes back to a snapshot goes on to the same bits as one that never did, whatever acts on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "made_up_balloon.h"
#include "physics/frame/kept_run.h"
#include "sheet_features.h"
#include "weft/mesh.h"
#include "weft/random.h"
#include "weft/read_scene.h"
#include "weft/shape.h"
#include "weft/simulation.h"
#include "weft/vec3.h"

namespace weft {
namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed, 0) {}
  bool one_in(int n) { return whole(n) == 0; }
  int whole(int n) { return int(random_.bits() % std::uint64_t(n)); }
  double between(double a, double b) { return a + (b - a) * random_.unit(); }
  Vec3 vector(double size) {
    return {size * random_.symmetric(), size * random_.symmetric(), size * random_.symmetric()};
  }
  template <class T>
  T of(std::initializer_list<T> values) {
    return values.begin()[whole(int(values.size()))];
  }

 private:
  Random random_;
};

Solver a_solver(Draw& draw) {
  Solver s;
  s.method = draw.of({Method::spring, Method::spring_friction, Method::compliant, Method::compliant,
                      Method::compliant, Method::positional});
  s.sweep = draw.of({Sweep::gauss_seidel, Sweep::line, Sweep::jacobi});
  s.iterations = 1 + draw.whole(2);
  if (s.method == Method::compliant) s.order = 1 + draw.whole(2);
  if (s.method == Method::compliant || s.method == Method::positional) s.tethers = draw.one_in(4);
  if (draw.one_in(3)) s.sleep = draw.of({1e-3, 0.05, 0.5});
  if (draw.one_in(4)) s.collision_iterations = 2;
  return s;
}

// A strip of triangles, or a ball that holds a gas, or two discs that are sewn.
void become_mesh(Draw& draw, Cloth& cloth) {
  const int kind = draw.whole(3);
  auto mesh = kind == 0   ? made_up_balloon(2, 0.2)
              : kind == 1 ? made_up_cushion(4, 0.05)
                          : std::make_shared<TriangleMesh>();
  if (kind == 1) {
    for (Vec3& p : mesh->vertices) p[0] *= 0.25, p[1] *= 0.25;
    cloth.sewing = true;
  }
  if (kind < 2 && draw.one_in(2)) cloth.pressure.inflate = draw.between(1, 1.01);
  constexpr int kSide = 8;
  for (int j = 0; kind == 2 && j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      mesh->vertices.push_back({0.06 * i, 0.002 * double((i * 5 + j * 3) % 7), 0.06 * j});
      if (i == 0 || j == 0) continue;
      const int d = j * kSide + i, c = d - 1, b = d - kSide, a = b - 1;
      mesh->triangles.push_back({a, d, b});
      mesh->triangles.push_back({a, c, d});
    }
  cloth.mesh.shape = std::move(mesh);
  cloth.mesh.translate = {0.25, 0.02, 0.25};
}

Cloth a_cloth(Draw& draw, int number) {
  Cloth cloth;
  const int nx = 5 + draw.whole(9), ny = 5 + draw.whole(9);
  cloth.grid = {nx, ny, {0.02 * number, 0.04 * number, 0}, {0.5, 0, 0}, {0, 0, 0.5}, 1e-3};
  if (draw.one_in(3)) become_mesh(draw, cloth);
  const double k = draw.of({50.0, 300.0, 2000.0});
  cloth.stiffness = {k, k / 2, k / 10};
  cloth.spring_damping = {0.01, 0.005, 0};
  if (draw.one_in(3)) cloth.membrane = {k, k / 2, k / 20, k / 8, draw.of({0.0, 1e-3})};
  if (draw.one_in(3)) cloth.bending = Bending(1e-4);
  if (draw.one_in(4)) cloth.bending.damping = 0.01;
  if (draw.one_in(2)) cloth.drag = draw.between(0, 4);
  if (draw.one_in(4)) cloth.strain_limit = draw.between(0.02, 0.1);
  cloth.strain_limit_order =
      draw.of({StrainLimitOrder::strict, StrainLimitOrder::colours, StrainLimitOrder::course});
  if (draw.one_in(4)) cloth.tear_strain = draw.between(0.02, 0.2);
  cloth.tears = draw.of({Tears::split, Tears::holes, Tears::particles});
  cloth.velocity = draw.vector(1);
  if (draw.one_in(3)) cloth.spin = draw.vector(4);
  if (draw.one_in(2))
    cloth.self_collision = {
        draw.of({SelfCollisionMode::particles, SelfCollisionMode::surface}),
        draw.between(0.01, 0.03), draw.of({0.0, 0.4}),
        draw.of({SelfCollisionResponse::stiff, SelfCollisionResponse::stiff,
                 SelfCollisionResponse::course, SelfCollisionResponse::neighbours})};
  const int pins = draw.whole(3);
  for (int n = 0; n < pins; ++n) {
    Pin pin{.i = n * (nx - 1), .j = 0, .keys = {}};
    if (cloth.mesh.given()) pin = {.i = 3 * n, .j = 0, .keys = {}};
    const Vec3 at{0.5 * n, 0.04 * number, 0};
    if (draw.one_in(3) && !cloth.mesh.given())
      pin.keys = {{0, at}, {0.08, plus(at, draw.vector(0.05))}, {0.2, at}};
    else if (draw.one_in(3))
      pin.rotate = {draw.vector(1), at, {{0, 0}, {0.2, 40}}};
    cloth.pins.push_back(pin);
  }
  return cloth;
}

Collider a_collider(Draw& draw) {
  const Vec3 at{0.25, -0.13, 0.25};
  Collider c = collider_of(Sphere{at, 0.12}, draw.of({0.0, 0.4}));
  switch (draw.whole(6)) {
    case 0:
      c.shape = Plane{{0, -0.03, 0}, {0.2, 1, 0}};
      break;
    case 1:
      c.shape = Capsule{{0, -0.08, 0.2}, {0.5, -0.06, 0.3}, 0.05};
      break;
    case 2:
      c.shape = Sphere{{0.26, -0.03, 0.24}, 0.02};
      break;
    case 3: {
      MeshBody body;
      body.shape = made_up_balloon(2, 0.12);
      body.translate = at;
      body.surface = surface_of(body);
      c.shape = body;
      break;
    }
    default:
      break;
  }
  c.offset = draw.of({0.0, 0.005});
  if (draw.one_in(3)) c.friction.damping = 5, c.friction.bias = 0.02;
  if (draw.one_in(3))
    c.keys = {{0, place_of(c.shape)}, {0.15, plus(place_of(c.shape), {0.02, 0.06, 0})}};
  if (draw.one_in(4)) c.rotate = {{0.1, 1, 0}, at, {{0, 0}, {0.3, 90}}};
  if (draw.one_in(8)) c.cuts = true;
  return c;
}

Scene a_scene(std::uint64_t seed) {
  Draw draw(seed);
  Scene scene;
  scene.solver = a_solver(draw);
  scene.time.frame = draw.of({1.0 / 60, 1.0 / 100});
  scene.time.substeps = draw.of({kAutoSubsteps, kAutoSubsteps, 3, 12, 200});
  const int cloths = 1 + draw.whole(2);
  for (int n = 0; n < cloths; ++n) scene.cloths.push_back(a_cloth(draw, n));
  for (int n = draw.whole(3); n > 0; --n) scene.colliders.push_back(a_collider(draw));
  if (draw.one_in(4)) scene.wind = {draw.vector(5), 0.6, 0.3, draw.of({0.0, 0.5})};
  if (draw.one_in(6)) scene.gravity_keys = {{0, {0, -9.81, 0}}, {0.2, draw.vector(9)}};
  return scene;
}

// What a hand does before a frame.
void touch(Simulation& run, std::uint64_t seed, int frame) {
  Draw draw(1000 * seed + std::uint64_t(frame));
  if (!draw.one_in(4)) return;
  const int particle = 4 + draw.whole(20);
  switch (draw.whole(7)) {
    case 0:
    case 1:
      run.grab(0, particle, {0.2, 0.15, 0.2}, 50);
      break;
    case 2:
      run.release();
      break;
    case 3:
      run.carry(0, draw.one_in(2) ? Vec3{} : draw.vector(0.3));
      break;
    case 4:
      run.pin(0, particle);
      break;
    case 5:
      run.unpin(0, particle);
      break;
    default:
      run.cut({0.2, -0.5, 0.2}, {0.2, 0.5, 0.25}, 0.03);
  }
}

struct Told {
  std::uint64_t hash;
  std::vector<double> velocities;
  std::vector<std::string> notes;
  int substeps;
  double energy;
  std::int64_t torn, contacts, all_substeps;
  bool ok;
  friend bool operator==(const Told&, const Told&) = default;
};

Told told(const Simulation& run) {
  const Report report = run.report(false);
  return {run.hash(),          run.velocities(), run.plan().notes,        run.substeps(),
          report.energy.total, report.torn,      report.contact.contacts, report.substeps,
          run.status().ok};
}

Options threads(int count) {
  Options options;
  options.threads = count;
  return options;
}

void expect_to_go_on(const Scene& scene, std::uint64_t seed, const std::string& name) {
  Draw draw(seed);
  const int before = 1 + draw.whole(8), after = 1 + draw.whole(6);
  const bool hands = draw.one_in(3);
  const auto go = [&](Simulation& run, int first, int count) {
    for (int n = first; n < first + count; ++n) {
      if (hands) touch(run, seed, n);
      run.advance_frame();
    }
  };
  Simulation never(scene, threads(1)), back(scene, threads(2)), fresh(scene, threads(1));
  go(never, 0, before + after);
  const Told all = told(never);
  go(back, 0, before);
  const Snapshot snapshot = back.snapshot();
  go(back, before, after);
  EXPECT_EQ(told(back), all) << name << ": a snapshot was taken";
  for (Simulation* run : {&back, &fresh}) {
    run->restore(snapshot);
    EXPECT_EQ(run->snapshot().run->kept, snapshot.run->kept) << name << ": put back";
    go(*run, before, after);
    EXPECT_EQ(told(*run), all) << name << (run == &fresh ? ": fresh" : ": gone on");
  }
}

class Features : public testing::TestWithParam<Solver> {};

TEST_P(Features, GoOnOneByOne) {
  for (std::uint64_t n = 0; const Feature& feature : features()) {
    Scene scene = hanging_sheet();
    scene.solver = GetParam();
    scene.time.substeps = n % 2 ? kAutoSubsteps : 10;
    feature.set(scene);
    if (validate(scene).empty()) expect_to_go_on(scene, ++n, feature.name);
  }
}

INSTANTIATE_TEST_SUITE_P(
    , Features,
    testing::Values(Solver{.method = Method::spring}, Solver{.method = Method::spring_friction},
                    Solver{.method = Method::positional}, Solver{.method = Method::compliant},
                    Solver{.method = Method::compliant, .sweep = Sweep::line},
                    Solver{.method = Method::compliant, .tethers = true, .order = 2},
                    Solver{.method = Method::compliant, .sweep = Sweep::line, .order = 2}));

// All at once.
class RandomRuns : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomRuns, GoOn) {
  int ran = 0;
  for (std::uint64_t seed = 1000 * GetParam(); ran < 12; ++seed) {
    const Scene scene = a_scene(seed);
    if (!validate(scene).empty()) continue;
    expect_to_go_on(scene, seed, "seed " + std::to_string(seed));
    ++ran;
  }
}

INSTANTIATE_TEST_SUITE_P(, RandomRuns, testing::Range<std::uint64_t>(0, 6));

}  // namespace
}  // namespace weft
