// The pair search against a brute-force oracle, and what the response does to pairs.
#include <cmath>
#include <cstdio>
#include <random>
#include <set>
#include <tuple>

#include "contact_scenes.h"
#include "machines.h"
#include "physics/contact/self/crossings.h"
#include "physics/contact/self/self_contact.h"
#include "physics/frame/cloth_step.h"
#include "physics/model/lattice/stages.h"
#include "squares.h"
#include "weft/vec3.h"

namespace weft {
namespace {

using physics::ClothStep;

Cloth colliding(Cloth cloth, double thickness) {
  cloth.self_collision.mode = SelfCollisionMode::particles;
  cloth.self_collision.thickness = thickness;
  return cloth;
}

using Pair = std::pair<std::array<int, 3>, std::array<int, 3>>;

std::set<Pair> all_pairs(const std::vector<std::unique_ptr<ClothStep>>& cloths, const Scene& scene,
                         float range) {
  struct One {
    std::array<int, 3> site;
    float x[3];
  };
  std::vector<One> all;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const physics::Lattice& l = cloths[c]->model().lattice()->lattice;
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i)
        all.push_back({{int(c), j, i}, {l.x.at(0, j, i), l.x.at(1, j, i), l.x.at(2, j, i)}});
  }
  std::set<Pair> pairs;
  for (const One& a : all)
    for (const One& b : all) {
      if (a.site == b.site) continue;
      float square = 0;
      for (int k = 0; k < 3; ++k) square += (b.x[k] - a.x[k]) * (b.x[k] - a.x[k]);
      if (square >= range * range) continue;
      const Grid& g = scene.cloths[std::size_t(a.site[0])].grid;
      const double di = double(a.site[2] - b.site[2]) / (g.nx - 1),
                   dj = double(a.site[1] - b.site[1]) / (g.ny - 1);
      const double near = 1.3 * scene.cloths[std::size_t(a.site[0])].self_collision.thickness;
      const double at_rest = std::hypot(di * g.u[0] + dj * g.v[0], di * g.u[1] + dj * g.v[1],
                                        di * g.u[2] + dj * g.v[2]);
      if (a.site[0] == b.site[0] && at_rest < near) continue;
      pairs.insert({a.site, b.site});
    }
  return pairs;
}

// Sheets strewn in a box, and searched for pairs within the greatest thickness and 0.01 m.
void expect_all_pairs(const Scene& scene, double size, Simd simd) {
  std::vector<std::unique_ptr<ClothStep>> cloths;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> within(0, float(size));
  double thickness = 0;
  for (int c = 0; c < int(scene.cloths.size()); ++c) {
    thickness = std::max(thickness, scene.cloths[std::size_t(c)].self_collision.thickness);
    cloths.push_back(
        std::make_unique<ClothStep>(scene, c, Method::spring, 1, physics::kernel_table(simd)));
    physics::Lattice& l = cloths.back()->model().lattice()->lattice;
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i)
        for (int k = 0; k < 3; ++k) l.x.at(k, j, i) = within(random) * (k == 1 ? 0.3f : 1.0f);
  }
  const auto self =
      physics::SelfContact::make(scene, physics::models_of(cloths), physics::kernel_table(simd));
  physics::Threads threads(2);
  self->search(0.01, threads);
  std::set<Pair> pairs;
  std::size_t listed = 0;
  self->for_each_pair([&](const physics::Site& p, const physics::Site& q) {
    const std::array<int, 3> a{p.cloth, p.row, p.column}, b{q.cloth, q.row, q.column};
    pairs.insert({a, b});
    pairs.insert({b, a});
    listed += 2;
  });
  EXPECT_EQ(listed, pairs.size()) << "a pair is listed twice";
  EXPECT_EQ(pairs, all_pairs(cloths, scene, float(thickness) + 0.01f)) << size;
  std::printf("box of %.2f m: %zu pairs\n", size, pairs.size());
}

const Simd kSearching[] = {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512};

// Two crumpled sheets, in boxes from a few to thousands of cells wide.
TEST(SelfCollisionPairs, SearchFindsWhatBruteForceFinds) {
  for (const double size : {0.05, 0.4, 3.0, 400.0, 4e7})
    for (const Simd simd : kSearching) {
      if (!simd_available(simd)) continue;
      Scene scene;
      scene.cloths.push_back(colliding(flat_sheet(30, 1, {0, 0, 0}), 0.05));
      scene.cloths.push_back(colliding(flat_sheet(17, 1, {0, 1, 0}), 0.06));
      expect_all_pairs(scene, size, simd);
    }
}

// Neighbours on the flat sheet are no pairs: on narrow sheets and sheared ones, and where the thickness
// spans many particles, or all.
TEST(SelfCollisionPairs, NeighboursAreNoPairs) {
  for (const double thickness : {0.004, 0.031, 0.3, 2.0})
    for (const Simd simd : kSearching) {
      if (!simd_available(simd)) continue;
      Scene scene;
      for (const auto& [nx, ny, shear] :
           {std::tuple{2, 60, 0.0}, {40, 3, 0.2}, {19, 23, 0.9}, {16, 17, -0.6}, {16, 16, 3.0}}) {
        Cloth cloth = colliding(flat_sheet(2, 1, {0, 0, 0}), thickness);
        cloth.grid.nx = nx;
        cloth.grid.ny = ny;
        cloth.grid.v = {shear, 0, 0.8};
        scene.cloths.push_back(cloth);
      }
      expect_all_pairs(scene, 0.3, simd);
    }
}

TEST(SelfCollisionPairs, CrossingsAreCountedOncePerEdgeAndTriangle) {
  const std::vector<Vec3> x = {{0, 0, 0},      {1, 0, 0},     {0, 0, 1},
                               {0.2, -1, 0.2}, {0.2, 1, 0.2}, {5, 1, 5}};
  EXPECT_EQ(physics::count_crossings(x, {{0, 1, 2}, {3, 4, 5}}), 2);  // two edges pass
  EXPECT_EQ(physics::count_crossings(x, {{0, 1, 2}, {0, 4, 5}}), 0);  // a shared corner
}

// Also where one edge is hundreds of times as long as the others.
TEST(SelfCollisionPairs, CrossingsAreThoseOfEveryEdgeAndTriangle) {
  constexpr int kSide = 8;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-0.01, 0.01);
  std::vector<Vec3> x;
  for (int p = 0; p < kSide * kSide; ++p)
    x.push_back({0.01 * (p % kSide) + anywhere(random), anywhere(random), 0.01 * (p / kSide)});
  std::vector<physics::Face> faces;
  add_squares(kSide, kSide, 0, faces);
  const std::vector<physics::Edge> edges = physics::edges_of(faces);
  for (const double pulled : {0.0, 5.0}) {
    x[0][1] += pulled;
    std::int64_t crossings = 0;
    for (const physics::Edge& e : edges)
      for (const physics::Face& f : faces)
        crossings += std::int64_t(physics::find_crossings(x, {f}, {e}).size());
    EXPECT_GT(crossings, 0);
    EXPECT_EQ(physics::count_crossings(x, faces), crossings) << pulled;
  }
}

// A plane sheet does not cross itself however it is turned and wherever it lies, though its rounded corners lie beside
// its plane; what passes through it by more than these do is found.
TEST(SelfCollisionPairs, PlaneSheetsDoNotCrossThemselves) {
  constexpr int kSide = 7;
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  std::vector<physics::Face> faces;
  add_squares(kSide, kSide, 0, faces);
  const int tip = kSide * kSide;
  for (int k = 0; k < 300; ++k) {
    const auto direction = [&] {
      const Vec3 d{any(random), any(random), any(random)};
      return times(d, 1 / length(d));
    };
    const double spacing = std::pow(10, -1 - k % 3), narrow = k % 2 == 0 ? 1 : 0.1;
    const Vec3 u = direction(), normal = cross(u, direction()), v = cross(normal, u);
    const Vec3 start = times(direction(), k % 5);
    std::vector<Vec3> x;
    const auto rounded = [&](double a, double b, double above) {
      const Vec3 n = times(normal, above / length(normal));
      const Vec3 at =
          plus(plus(start, n), plus(times(u, a * spacing), times(v, b * spacing * narrow)));
      x.push_back({double(float(at[0])), double(float(at[1])), double(float(at[2]))});
    };
    for (int p = 0; p < kSide * kSide; ++p) rounded(p % kSide, p / kSide, 0);
    EXPECT_EQ(physics::count_crossings(x, faces), 0) << k;
    std::vector<physics::Face> more = faces;
    more.push_back({tip, tip + 1, tip + 2});
    for (const double above : {spacing, -spacing, spacing}) rounded(3.3, 2.4, 0.1 * above);
    x.back()[0] += 0.1 * spacing;
    EXPECT_GT(physics::count_crossings(x, more), 0) << k;
  }
}

// Two loose sheets laid upon each other come to rest a thickness apart.
TEST(SelfCollisionPairs, SheetsRestAThicknessApart) {
  for (const Method method : {Method::spring, Method::compliant}) {
    Scene scene;
    scene.solver.method = method;
    for (const double height : {0.02, 0.08, 0.14}) {
      scene.cloths.push_back(colliding(flat_sheet(20, 0.4, {0, height, 0}), 0.03));
      scene.cloths.back().drag = 3;
    }
    scene.colliders.push_back(collider_of(Plane{}, 0.5));
    Simulation simulation(scene);
    advance(simulation, 2);
    const Report r = simulation.report();
    std::printf("stack of three: %lld pairs under the thickness, %.2g m at most, %lld crossings\n",
                (long long)r.penetration.self_pairs, r.penetration.self_max,
                (long long)r.penetration.crossings);
    EXPECT_LT(r.penetration.self_max, 0.01 * 0.03);
    EXPECT_EQ(r.penetration.crossings, 0);
    EXPECT_GT(at(simulation.positions(), 800 + 210)[1], 0.05);
  }
}

TEST(SelfCollisionPairs, FrictionCarriesAnUpperSheetAlong) {
  for (const double friction : {0.0, 0.6}) {
    Scene scene;
    scene.gravity = {0.3 * 9.81, -9.81, 0};  // a slope of 17 degrees, where 0.6 sticks
    for (const double height : {0.0, 0.0155}) {
      scene.cloths.push_back(colliding(flat_sheet(12, 0.12, {0, height, 0}), 0.015));
      scene.cloths.back().self_collision.friction = friction;
    }
    for (int n = 0; n < 144; ++n) scene.cloths[0].pins.push_back({n % 12, n / 12, {}});
    Simulation simulation(scene);
    const double start = at(simulation.positions(), 144 + 66)[0];
    advance(simulation, 0.12);
    const double slid = at(simulation.positions(), 144 + 66)[0] - start;
    std::printf("friction %.1f: slid %.4f m\n", friction, slid);
    if (friction == 0)
      EXPECT_GT(slid, 0.01);
    else
      EXPECT_LT(slid, 0.009);
  }
}

TEST(SelfCollisionPairs, AskingForAReportChangesNothing) {
  Scene scene;
  scene.cloths.push_back(colliding(flat_sheet(30, 0.5, {0, 0.3, 0}), 0.015));
  scene.cloths[0].grid.v = {0, 0.5, 0};
  scene.cloths[0].grid.jitter = 0.001;
  scene.colliders.push_back(collider_of(Plane{}, 0.5));
  Simulation plain(scene), asked(scene, {2, Simd::best, 1, true});
  for (int n = 0; n < 60; ++n) {
    plain.advance_frame();
    asked.advance_frame();
    (void)asked.report();
  }
  EXPECT_EQ(plain.hash(), asked.hash());
}

TEST(SelfCollisionPairs, SameBitsForAnyThreadsAndInstructionSet) {
  Scene scene;
  scene.cloths.push_back(colliding(flat_sheet(70, 0.7, {0, 0.3, 0}), 0.015));
  scene.cloths[0].grid.v = {0, 0.7, 0.05};
  scene.cloths[0].stiffness = {1000, 500, 20};
  scene.colliders.push_back(collider_of(Plane{}, 0.5));
  std::vector<std::uint64_t> hashes;
  for (const Options& o : machines()) {
    Simulation simulation(scene, o);
    advance(simulation, 0.5);
    hashes.push_back(simulation.hash());
  }
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

}  // namespace
}  // namespace weft
