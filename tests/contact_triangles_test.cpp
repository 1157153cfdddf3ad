// Triangles as they are now stay out of bodies, however long the sheet is drawn: by an independent measure
// of every triangle (body_distance.h).
#include <algorithm>
#include <random>

#include "body_distance.h"
#include "cases.h"
#include "contact_scenes.h"
#include "physics/contact/triangle_shape.h"
#include "weft/report.h"
#include "weft/shape.h"

namespace weft {
namespace {

constexpr double kRounding = 1e-5;  // m

double deepest(const Simulation& simulation, std::size_t collider = 0) {
  const Scene& scene = simulation.scene();
  const Collider& c = scene.colliders[collider];
  const Grid& g = scene.cloths[0].grid;
  const Vec3 by = displacement(c, simulation.time());
  return tests::deepest_triangle(simulation.positions(), g.nx, g.ny, c, by);
}

const std::vector<Method> kMethods{Method::spring, Method::spring_friction, Method::compliant,
                                   Method::positional};

// How far a triangle that cuts a core is told to move: that far it leaves the core; not much further than along the
// best of many random directions; and not at all where one of them shows that the two are apart.
TEST(ContactTriangles, LeaveACoreTheShortestWay) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::normal_distribution<double> any;
  const auto compare = [&](const auto& shape) {
    int cuts = 0;
    for (int n = 0; n < 300; ++n) {
      const Vec3 middle{unit(random) / 4, unit(random) / 4, unit(random) / 4};
      physics::Triangle t;
      for (Vec3& x : t)
        for (std::size_t k = 0; k < 3; ++k) x[k] = middle[k] + 0.2 * unit(random);
      const auto depth_along = [&](const Vec3& way) {
        double low = 1e300;
        for (const Vec3& x : t) low = std::min(low, dot(way, x));
        return dot(way, physics::support_of(shape, way)) - low;
      };
      std::vector<physics::Overlap> looks;
      const auto look = [&](const Vec3& way) {
        const Vec3 normal = times(way, 1 / length(way));
        return physics::Overlap{depth_along(normal), normal};
      };
      for (int k = 0; k < 1500; ++k) looks.push_back(look({any(random), any(random), any(random)}));
      constexpr int kBest = 5;
      const auto by_depth = [](const auto& a, const auto& b) { return a.depth < b.depth; };
      std::partial_sort(looks.begin(), looks.begin() + kBest, looks.end(), by_depth);
      double least = 1e300;
      for (int best = 0; best < kBest; ++best) {
        physics::Overlap here = looks[std::size_t(best)];
        for (double h = 0.05; h > 1e-4; h *= 0.7)
          for (int k = 0; k < 20; ++k) {
            Vec3 way = here.normal;
            for (double& c : way) c += h * any(random);
            here = std::min(here, look(way), by_depth);
          }
        least = std::min(least, here.depth);
      }
      const physics::Overlap told = physics::overlap_of(shape, t);
      cuts += least > 0;
      EXPECT_GE(told.depth, 0);
      EXPECT_LE(told.depth, std::max(least, 0.0) * 1.05 + 1e-6) << Shape(shape).index();
      if (told.depth == 0) continue;
      EXPECT_NEAR(told.depth, depth_along(told.normal), 1e-12);
    }
    EXPECT_GT(cuts, 5) << Shape(shape).index();
  };
  compare(Box{{}, {0.1, 0.05, 0.2}, {20, 0, 50}, 0.01});
  compare(Capsule{{}, {0.3, 0.1, 0.2}, 0.03});
  compare(Cylinder{{}, {0.1, 0.2, 0.1}, 0.15, 0.02});
  compare(Cylinder{{}, {0.004, 0.008, 0.004}, 0.3, 0});
  compare(Cylinder{{-0.2, -0.1, 0}, {0.3, 0.2, 0.2}, 0.01, 0});
  compare(TaperedCapsule{{}, {0.3, 0.1, 0.2}, 0.03, 0.1});
  compare(TaperedCapsule{{}, {0.2, 0, 0.1}, 0.2, 0.05});
  compare(TaperedCapsule{{}, {0.3, 0.1, 0.2}, 0.03, 0.03});
}

// The nearest points of triangles and cores of any proportions, against minimisation.
TEST(ContactTriangles, FindsTheDeepestPointOfAnyTriangle) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const double offset = 0.01;
  Cases cases(3);
  const std::vector<Shape> shapes{
      Box{{}, {0.1, 0.05, 0.2}, {}, 0.01},       Box{{}, {0.3, 0.001, 0.2}, {}, 0},
      Capsule{{}, {0.3, 0.1, 0.2}, 0.03},        Sphere{{}, 0.1},
      Cylinder{{}, {0.1, 0.2, 0.1}, 0.15, 0.02}, TaperedCapsule{{}, {0.3, 0.1, 0.2}, 0.03, 0.1}};
  for (const Shape& shape : shapes)
    for (const double size : {0.05, 0.3, 1.0, 5.0, 20.0})
      for (int n = 0; n < 300; ++n) {
        if (!cases.next()) continue;
        const Vec3 middle{unit(random) / 4, unit(random) / 4, unit(random) / 4};
        physics::Corners c{};
        for (Vec3& x : c.x)
          for (int k = 0; k < 3; ++k) x[k] = middle[k] + size / 2 * unit(random);
        const double truth = tests::least_on_triangle(c.x, [&](const Vec3& p) {
          return std::visit([&](const auto& s) { return tests::distance_from(s, p); }, shape);
        });
        const auto compare = [&](const auto& s) {
          // A round core is known to what deepest_on() promises, others end exactly.
          const bool round = std::holds_alternative<Cylinder>(shape) ||
                             std::holds_alternative<TaperedCapsule>(shape);
          const double found = physics::deepest_on(s, c, offset, size).nearest.distance;
          const double core = -physics::core_of(s, c.x[0]).radius;
          if (truth > offset)
            EXPECT_GE(found, offset - 1e-9);
          else if (truth > core + 1e-6)
            EXPECT_NEAR(found, truth, (round ? 1e-4 : 2e-5) * size)
                << shape.index() << ", " << size << " m";
          else  // cut: what it takes to get out is no less than that
            EXPECT_LE(found, truth + 1e-9);
        };
        std::visit(
            [&](const auto& s) {
              // Bodies that are meshes are no shapes with a core (mesh_body_test.cpp).
              if constexpr (!std::is_same_v<decltype(s), const MeshBody&>) compare(s);
            },
            shape);
      }
}

// A soft sheet that two edges draw to three times its length, above a body that its mesh at rest
// resolves; then the edges go down beside the body.
Scene drawn_over(const Shape& shape, Method method, int points, double offset) {
  Scene scene;
  scene.time.substeps = 40;
  scene.solver.method = method;
  scene.cloths.push_back(flat_sheet(points, 0.5, {0, 0.25, 0}));
  Cloth& cloth = scene.cloths[0];
  cloth.stiffness = {2, 1, 0.2};
  cloth.positional_k = 0.02;  // else it cannot be drawn so far
  cloth.drag = 2;
  for (int j = 0; j < points; ++j)
    for (const int side : {-1, 1}) {
      const double z = 0.5 * (j / double(points - 1) - 0.5);
      cloth.pins.push_back({side < 0 ? 0 : points - 1,
                            j,
                            {{0, {0.25 * side, 0.25, z}},
                             {0.3, {0.75 * side, 0.25, z}},
                             {0.7, {0.6 * side, -0.3, z}}}});
    }
  scene.colliders.push_back(collider_of(shape, 0.3));
  scene.colliders[0].offset = offset;
  return scene;
}

// A body inside a single square, all corners far from it: the report tells how deep it is.
TEST(ContactTriangles, TheReportSeesABodyWithinATriangle) {
  for (const double height : {0.0, 0.1, 0.2, 0.35}) {
    Scene scene;
    scene.cloths.push_back(flat_sheet(2, 3, {0, height, 0}));
    scene.colliders.push_back(collider_of(Sphere{{0.3, 0, 0.3}, 0.3}));
    const Simulation simulation(scene);
    EXPECT_NEAR(simulation.report().penetration.collider_max, std::max(0.0, 0.3 - height), 1e-6);
  }
}

TEST(ContactTriangles, SheetDrawnToThreeTimesItsLengthStaysOut) {
  const std::vector<Shape> shapes{Sphere{{0, 0, 0}, 0.2},
                                  Capsule{{0, 0, -0.15}, {0, 0, 0.15}, 0.15},
                                  Box{{0, 0, 0}, {0.2, 0.15, 0.2}, {0, 30, 0}, 0.12}};
  Cases cases(5);
  for (const Shape& shape : shapes)
    for (const Method method : kMethods)
      for (const int points : {9, 21})
        for (const double offset : {0.0, 0.005}) {
          if (!cases.next() ||
              !resolves(drawn_over(shape, method, points, offset).cloths[0], collider_of(shape, 0)))
            continue;
          Simulation simulation(drawn_over(shape, method, points, offset));
          double worst = -1, strain = 0;
          for (int frame = 0; frame < 60; ++frame) {
            simulation.advance_frame();
            if (frame % 12 == 11 && frame > 20) {
              worst = std::max(worst, deepest(simulation));
              strain = std::max(strain, simulation.report(false).strain.max);
            }
          }
          EXPECT_GT(strain, 1.5);
          EXPECT_LT(worst, kRounding) << shape.index() << ", method " << int(method) << ", "
                                      << points << " points, offset " << offset << " m";
          EXPECT_LT(simulation.report().penetration.collider_max, 1e-4);
        }
}

// A ball of any size against the mesh flies at 50 m/s into a curtain held by its border.
TEST(ContactTriangles, CurtainHoldsAFastBall) {
  for (const Method method : kMethods)
    for (const double radius : {0.01, 0.06, 0.2})
      for (const double speed : {5.0, 50.0}) {
        Scene scene;
        scene.gravity = {0, 0, 0};
        scene.time = {1.0 / 240, 20, 1};
        scene.solver.method = method;
        scene.cloths.push_back(flat_sheet(13, 0.6, {0, 0, 0}));
        scene.cloths[0].stiffness = {500, 300, 50};
        for (int n = 0; n < 13; ++n)
          for (const auto& [i, j] : {std::pair{n, 0}, {n, 12}})
            scene.cloths[0].pins.push_back({i, j, {}});
        const Vec3 from{0.013, 0.3, 0.007};
        scene.colliders.push_back(collider_of(Sphere{from, radius}, 0.2));
        scene.colliders[0].offset = 0.002;
        const double way = 0.42 - radius;  // to 12 cm below the curtain
        scene.colliders[0].keys = {{0, from}, {way / speed, {from[0], from[1] - way, from[2]}}};
        Simulation simulation(scene);
        double worst = -1;
        const int frames = int(1.2 * way / speed * 240) + 2;
        for (int frame = 0; frame < frames; ++frame) {
          simulation.advance_frame();
          worst = std::max(worst, deepest(simulation));
          ASSERT_TRUE(simulation.status().ok);
        }
        // Hardly stretched triangles may lie below the offset as far as they do at rest: 4 mm here.
        EXPECT_LT(worst, 0.0025) << "method " << int(method) << ", radius " << radius << " m, "
                                 << speed << " m/s";
        // The ball carries it along: its lowest particle is below the ball.
        double lowest = 0;
        const std::vector<double> x = simulation.positions();
        for (std::size_t p = 1; p < x.size(); p += 3) lowest = std::min(lowest, x[p]);
        EXPECT_LT(lowest, -0.1) << radius << ' ' << speed << ' ' << int(method);
      }
}

// A sheet falls onto the sharp corner of a box that stands on its tip, which the mesh does not resolve.
TEST(ContactTriangles, ConeOfClothOnTheTipOfABox) {
  for (const Method method : kMethods)
    for (const double edge : {0.02, 0.2}) {
      Scene scene;
      scene.time.substeps = 40;
      scene.solver.method = method;
      scene.cloths.push_back(flat_sheet(17, 0.5, {0.011, 0.2 + edge, 0.007}));
      scene.cloths[0].drag = 2;
      scene.colliders.push_back(collider_of(Box{{}, {edge, edge, edge}, {45, 0, 35.264}, 0}, 0.6));
      scene.colliders[0].offset = 0.003;
      Simulation simulation(scene);
      double worst = -1;
      for (int frame = 0; frame < 40; ++frame) {
        simulation.advance_frame();
        if (frame % 4 == 3) worst = std::max(worst, deepest(simulation));
      }
      EXPECT_LT(worst, kRounding) << "method " << int(method) << ", edge " << edge << " m";
      const Report report = simulation.report();
      EXPECT_TRUE(report.finite);
      EXPECT_LT(report.energy.kinetic, 0.5);
    }
}

// Two halves of a torn curtain are no triangle: a ball passes between them and moves neither.
TEST(ContactTriangles, NothingHoldsWhatIsTorn) {
  for (const Method method : kMethods) {
    Scene scene;
    scene.gravity = {0, 0, 0};
    scene.time.substeps = 20;
    scene.solver.method = method;
    scene.cloths.push_back(flat_sheet(12, 0.55, {0, 0, 0}));
    Cloth& cloth = scene.cloths[0];
    cloth.tear_strain = 10;
    for (int j = 0; j < 12; ++j)
      for (int i = 0; i < 12; ++i) {
        const double side = i < 6 ? -1 : 1;
        const Vec3 start{(i - 5.5) * 0.05, 0, (j - 5.5) * 0.05};
        const Vec3 apart{start[0] + 0.3 * side, 0, start[2]};
        cloth.pins.push_back({i, j, {{0, start}, {0.1, apart}}});
      }
    scene.colliders.push_back(collider_of(Sphere{{0, 0.5, 0}, 0.2}));
    scene.colliders[0].keys = {{0.2, {0, 0.5, 0}}, {0.7, {0, -0.5, 0}}};
    Simulation simulation(scene);
    simulation.cut({0, 0, -1}, {0, 0, 1}, 0.01);
    advance(simulation, 0.15);
    // From now on the halves are free.
    for (int particle = 0; particle < 144; ++particle) simulation.unpin(0, particle);
    const std::vector<double> before = simulation.positions();
    simulation.set_state(before, std::vector<double>(before.size()));
    advance(simulation, 0.8);
    const std::vector<double> after = simulation.positions();
    for (std::size_t p = 0; p < after.size(); ++p) ASSERT_NEAR(after[p], before[p], 1e-3);
  }
}

// The long edges of one sheet do not make a far one look, and what is far costs nothing.
TEST(ContactTriangles, FarRowsArePassedOver) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.time.substeps = 20;
  scene.cloths.push_back(flat_sheet(33, 0.5, {0, 0, 0}));
  scene.colliders.push_back(collider_of(Sphere{{0, 3, 0}, 0.4}));
  Simulation simulation(scene);
  advance(simulation, 1);
  int told = 0;
  for (const SkippedStage& s : simulation.report().skipped)
    if (s.name == "stretched_faces") {
      ++told;
      double percent = 0;
      const std::size_t at = s.why.find_first_of("0123456789");
      percent = std::stod(s.why.substr(at));
      EXPECT_GT(percent, 50);
    }
  EXPECT_EQ(told, 1);
}

// Two bodies close on a sheet until they leave 2 mm, where their offsets ask for 10: it stays calm.
TEST(ContactTriangles, SheetPinchedBetweenTwoBodiesDoesNotExplode) {
  const std::vector<std::pair<Shape, Shape>> pairs{
      {Box{{0, 0.3, 0}, {0.15, 0.05, 0.15}, {}, 0.01},
       Box{{0, -0.06, 0}, {0.15, 0.05, 0.15}, {}, 0}},
      {Sphere{{0.02, 0.4, 0.01}, 0.15}, Plane{{0, -0.01, 0}, {0, 1, 0}}},
      {Sphere{{0, 0.5, 0}, 0.02}, Sphere{{0, -0.12, 0}, 0.1}}};
  for (const auto& [upper, lower] : pairs)
    for (const Method method : kMethods)
      for (const double speed : {0.2, 5.0}) {
        Scene scene;
        scene.time.substeps = 30;
        scene.solver.method = method;
        scene.cloths.push_back(flat_sheet(17, 0.5, {0, 0.02, 0}));
        scene.cloths[0].drag = 1;
        scene.colliders = {collider_of(lower, 0.3), collider_of(upper, 0.3)};
        for (Collider& c : scene.colliders) c.offset = 0.005;
        const Vec3 from = place_of(upper);
        const double way = std::holds_alternative<Sphere>(lower) ? 0.498 : 0.258;
        scene.colliders[1].keys = {{0.1, from},
                                   {0.1 + way / speed, {from[0], from[1] - way, from[2]}}};
        Simulation simulation(scene);
        double fastest = 0;
        for (int frame = 0; frame < int(60 * (0.3 + way / speed)); ++frame) {
          simulation.advance_frame();
          ASSERT_TRUE(simulation.status().ok);
          for (const double v : simulation.velocities()) fastest = std::max(fastest, std::abs(v));
        }
        EXPECT_LT(fastest, 10 * (speed + 1))
            << upper.index() << ", method " << int(method) << ", " << speed << " m/s";
      }
}

}  // namespace
}  // namespace weft
