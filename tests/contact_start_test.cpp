// Scenes that begin badly: what is refused, what is said, and what is put right without a bang.
#include <algorithm>
#include <cstdio>

#include "contact_scenes.h"

namespace weft {
namespace {

bool faults_at(const Scene& scene, const std::string& place) {
  const std::vector<Fault> faults = validate(scene);
  return std::any_of(faults.begin(), faults.end(),
                     [&](const Fault& f) { return f.place == place && !f.allowed.empty(); });
}

std::string notes_of(const Simulation& simulation) {
  std::string all;
  for (const std::string& note : simulation.plan().notes) all += note + "\n";
  return all;
}

Scene with(const Shape& shape) {
  Scene scene;
  scene.cloths.push_back(flat_sheet(20, 1, {0, 0, 0}));
  scene.cloths[0].drag = 1;
  scene.colliders.push_back(collider_of(shape, 0.2));
  return scene;
}

// Runs for half a second; the greatest component of a velocity and the greatest strain in it.
std::pair<double, double> half_a_second(Simulation& simulation) {
  double fastest = 0, longest = 0;
  while (simulation.time() < 0.5) {
    simulation.advance_frame();
    for (const double c : simulation.velocities()) fastest = std::max(fastest, std::abs(c));
    longest = std::max(longest, simulation.report().strain.max);
  }
  return {fastest, longest};
}

TEST(ContactStart, CollidersOfNoSizeAreRefused) {
  for (const double size : {0.0, -0.1}) {
    EXPECT_TRUE(faults_at(with(Sphere{{}, size}), "/colliders/0/sphere/radius"));
    EXPECT_TRUE(faults_at(with(Capsule{{}, {0, 1, 0}, size}), "/colliders/0/capsule/radius"));
    EXPECT_TRUE(faults_at(with(Box{{}, {0.1, size, 0.1}, {}, 0}), "/colliders/0/box/half/1"));
  }
  EXPECT_TRUE(faults_at(with(Plane{{}, {0, 0, 0}}), "/colliders/0/plane/normal"));
  EXPECT_TRUE(validate(with(Sphere{{}, 0.1})).empty());
}

TEST(ContactStart, CuttersWithoutReachAreRefused) {
  Scene scene = with(Sphere{{0, 1, 0}, 1e-4});
  EXPECT_TRUE(validate(scene).empty());
  scene.colliders[0].cuts = true;
  EXPECT_TRUE(faults_at(scene, "/colliders/0/cuts"));
  scene.colliders[0].offset = 0.01;
  EXPECT_TRUE(validate(scene).empty());
}

TEST(ContactStart, PinsOutsideOfTheGridAreRefused) {
  Scene scene = with(Sphere{{0, -1, 0}, 0.1});
  scene.cloths[0].pins = {{0, 20, {}}};
  EXPECT_TRUE(faults_at(scene, "/cloths/0/pins/0"));
}

TEST(ContactStart, ThicknessAboveTheSpacingSaysWhatItDoes) {
  Scene scene = with(Sphere{{0, -1, 0}, 0.1});
  scene.cloths[0].self_collision = {SelfCollisionMode::particles, 0.03, 0.3,
                                    SelfCollisionResponse::stiff};
  EXPECT_EQ(notes_of(Simulation(scene)).find("above the spacing"), std::string::npos);
  scene.cloths[0].self_collision.thickness = 0.08;
  Simulation simulation(scene);
  EXPECT_NE(notes_of(simulation).find("above the spacing"), std::string::npos);
  // The flat sheet does not push itself apart.
  advance(simulation, 0.3);
  EXPECT_LT(simulation.report().strain.max, 0.01);
}

TEST(ContactStart, ThicknessBelowHalfADiagonalSaysThatItLeaks) {
  Scene scene = with(Sphere{{0, -1, 0}, 0.1});
  const Grid& g = scene.cloths[0].grid;
  const double half_diagonal = std::hypot(spacing_u(g), spacing_v(g)) / 2;
  for (const auto mode : {SelfCollisionMode::particles, SelfCollisionMode::surface})
    for (const double share : {0.99, 1.01}) {
      scene.cloths[0].self_collision = {mode, share * half_diagonal, 0.3,
                                        SelfCollisionResponse::stiff};
      const bool told = notes_of(Simulation(scene)).find("half the diagonal") != std::string::npos;
      EXPECT_EQ(told, mode == SelfCollisionMode::particles && share < 1) << share;
    }
}

// A sheet through the middle of every shape is told of, and lifted off within a few frames, without
// flying off or tearing itself apart.
TEST(ContactStart, SheetsInsideCollidersAreMovedOutGently) {
  for (const Shape& shape :
       {Shape(Sphere{{0, 0.05, 0}, 0.25}), Shape(Capsule{{-0.2, -0.05, 0}, {0.2, -0.05, 0}, 0.15}),
        Shape(Box{{0, -0.08, 0}, {0.3, 0.1, 0.3}, {0, 20, 0}, 0.02}),
        Shape(Plane{{0, 0.2, 0}, {0, 1, 0}})})
    for (const Method method : {Method::spring, Method::compliant}) {
      Scene scene = with(shape);
      scene.solver.method = method;
      scene.gravity = {0, 0, 0};
      Simulation simulation(scene);
      const std::string notes = notes_of(simulation);
      EXPECT_NE(notes.find("starts inside collider 0"), std::string::npos) << notes;
      const auto [fastest, longest] = half_a_second(simulation);
      const Report r = simulation.report();
      std::printf("shape %zu, method %d: fastest %.2f m/s, longest %.0f %%, deepest %.2g m\n",
                  shape.index(), int(method), fastest, 100 * longest, r.penetration.collider_max);
      EXPECT_TRUE(r.finite);
      EXPECT_LT(r.penetration.collider_max, 1e-4);
      EXPECT_LT(fastest, 8);
      EXPECT_LT(longest, 1.2);
    }
}

// A collider smaller than the mesh, in a triangle without a particle inside, is told of too, and moves
// the triangle out as gently.
TEST(ContactStart, TrianglesPiercedAtTheStartAreMovedOutGently) {
  const double third = 1.0 / 19 / 3;  // of the spacing
  for (const Shape& shape : {Shape(Sphere{{third, 0, third}, 0.012}),
                             Shape(Capsule{{third, -0.02, third}, {third, 0.005, third}, 0.008}),
                             Shape(Box{{third, -0.01, third}, {0.008, 0.015, 0.008}, {}, 0.002})})
    for (const Method method : {Method::spring, Method::compliant})
      // The heavier particles are, the more what holds them back stretches.
      for (const auto& [lumping, mass] :
           {std::pair{Lumping::equal, 1.0 / (20 * 20)}, {Lumping::area, 1.0 / (19 * 19)}}) {
        Scene scene = with(shape);
        scene.solver.method = method;
        scene.cloths[0].lumping = lumping;
        scene.gravity = {0, 0, 0};
        Simulation simulation(scene);
        const std::string notes = notes_of(simulation);
        EXPECT_NE(notes.find("starts inside collider 0: 0 particles, "), std::string::npos)
            << notes;
        EXPECT_NE(notes.find("triangles, up to "), std::string::npos) << notes;
        const auto [fastest, longest] = half_a_second(simulation);
        std::printf("shape %zu, method %d: fastest %.2f m/s, longest %.2f %%\n", shape.index(),
                    int(method), fastest, 100 * longest);
        EXPECT_LT(fastest, 0.2);
        EXPECT_LT(longest, 0.005 * mass * 400);
      }
}

TEST(ContactStart, SheetsThatOnlyTouchAreLeftAlone) {
  Scene scene = with(Plane{{0, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(notes_of(Simulation(scene)).find("inside"), std::string::npos);
}

// Two sheets start in each other.
TEST(ContactStart, SheetsInEachOtherArePushedApart) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  for (const double y : {0.0, 0.002}) {
    scene.cloths.push_back(flat_sheet(20, 1, {0.01 * (y > 0), y, 0}));
    scene.cloths.back().drag = 1;
    scene.cloths.back().self_collision.mode = SelfCollisionMode::particles;
    scene.cloths.back().self_collision.thickness = 0.03;
  }
  Simulation simulation(scene);
  const std::string notes = notes_of(simulation);
  EXPECT_NE(notes.find("start nearer than the thickness"), std::string::npos) << notes;
  double fastest = 0;
  while (simulation.time() < 1) {
    simulation.advance_frame();
    for (const double v : simulation.velocities()) fastest = std::max(fastest, std::abs(v));
  }
  const Report r = simulation.report();
  std::printf("two sheets: fastest %.2f m/s, %lld pairs left\n", fastest,
              (long long)r.penetration.self_pairs);
  EXPECT_EQ(r.penetration.self_pairs, 0);
  EXPECT_EQ(r.penetration.crossings, 0);
  EXPECT_LT(fastest, 4);
}

// A sheet that was far from a body, and of which nothing was looked at for long, is set right above it.
TEST(ContactStart, AStateThatIsSetIsLookedAtAtOnce) {
  for (const double radius : {0.3, 0.02})  // kept out by particles, and by triangles
    for (const bool cuts : {false, true}) {
      Scene scene;
      scene.gravity = {0, 0, 0};
      scene.cloths.push_back(flat_sheet(20, 1, {0, 40, 0}));
      scene.colliders.push_back(collider_of(Sphere{{0, 0, 0}, radius}));
      scene.colliders[0].cuts = cuts;
      Simulation simulation(scene);
      for (int frame = 0; frame < 3; ++frame) simulation.advance_frame();
      std::vector<double> x = simulation.positions(), v(x.size(), 0.0);
      for (std::size_t p = 1; p < x.size(); p += 3) {
        x[p] = radius + 0.01;
        v[p] = -1;
      }
      simulation.set_state(x, v);
      for (int frame = 0; frame < 12; ++frame) {
        simulation.advance_frame();
        EXPECT_TRUE(cuts || simulation.report().penetration.collider_max < 1e-3) << radius;
      }
      EXPECT_EQ(simulation.report().torn > 0, cuts) << radius;
    }
}

}  // namespace
}  // namespace weft
