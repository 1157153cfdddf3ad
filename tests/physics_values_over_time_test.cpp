// Values over time: gravity and wind along keys, velocity and spin at the start, pins that turn or follow.
#include <numbers>

#include "contact_scenes.h"
#include "weft/read_scene.h"
#include "weft/report.h"

namespace weft {
namespace {

double length_of(const Vec3& a) {
  return std::hypot(a[0], a[1], a[2]);
}

const std::vector<Method> kMethods{Method::spring, Method::spring_friction, Method::compliant,
                                   Method::positional};

Scene free_sheet(Method method, int substeps) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.time.substeps = substeps;
  scene.solver.method = method;
  scene.cloths.push_back(flat_sheet(9, 0.4, {0.3, 0.2, 0.1}));
  return scene;
}

// g rises from 0 to G within a second: v = G t²/2, x = G t³/6, and on with G.
TEST(ValuesOverTime, FreeFallFollowsTheKeysOfGravity) {
  for (const Method method : kMethods)
    for (const int substeps : {8, 32}) {
      Scene scene = free_sheet(method, substeps);
      scene.cloths[0].stiffness = {20, 10, 2};
      scene.gravity_keys = {{0, {0, 0, 0}}, {1, {3, -10, 0}}};
      Simulation simulation(scene);
      const std::vector<double> start = simulation.positions();
      advance(simulation, 1.5);
      const double fallen = 1 / 6.0 + 0.5 * 0.5 + 0.125, speed = 0.5 + 0.5;
      const double tolerance =
          0.6 * scene.time.frame / substeps * 10;  // m; one substep of first order
      const std::vector<double> x = simulation.positions(), v = simulation.velocities();
      for (std::size_t p = 0; p < x.size(); p += 3) {
        EXPECT_NEAR(x[p] - start[p], 3 * fallen, tolerance) << int(method) << ' ' << substeps;
        EXPECT_NEAR(x[p + 1] - start[p + 1], -10 * fallen, tolerance);
        EXPECT_NEAR(v[p + 1], -10 * speed, 0.01 * 10 * speed);
      }
      EXPECT_FALSE(simulation.plan().fallback);
    }
}

// A long fall under keyed gravity is as free as under a constant one.
TEST(ValuesOverTime, ConstantKeysAreTheConstant) {
  for (const Method method : kMethods) {
    Scene scene = free_sheet(method, 10);
    scene.gravity = {0.5, -9.81, 0.25};
    Scene keyed = scene;
    keyed.gravity = {0, -9.81, 0};
    keyed.gravity_keys = {{0, scene.gravity}};
    Simulation a(scene), b(keyed);
    for (int frame = 0; frame < 300; ++frame) {
      a.advance_frame();
      b.advance_frame();
    }
    EXPECT_EQ(a.hash(), b.hash()) << int(method);
    EXPECT_NEAR(a.report().energy.gravity, b.report().energy.gravity, 1e-9);
  }
}

TEST(ValuesOverTime, ConstantKeysOfWindAreTheConstant) {
  Scene scene = free_sheet(Method::spring, 20);
  scene.wind.velocity = {2, 1, 0};
  scene.wind.drag = 1;
  Scene keyed = scene;
  keyed.wind.velocity = {};
  keyed.wind.velocity_keys = {{0, {2, 1, 0}}, {1, {2, 1, 0}}};
  Simulation a(scene), b(keyed);
  advance(a, 0.5);
  advance(b, 0.5);
  EXPECT_EQ(a.hash(), b.hash());
}

// Wind that turns up blows the sheet along then, and not before.
TEST(ValuesOverTime, WindFollowsItsKeys) {
  Scene scene = free_sheet(Method::compliant, 10);
  scene.wind.velocity_keys = {{0, {0, 0, 0}}, {0.5, {0, 0, 0}}, {0.6, {0, 5, 0}}};
  scene.wind.drag = 1;
  Simulation simulation(scene);
  const std::vector<double> start = simulation.positions();
  advance(simulation, 0.5);
  for (std::size_t p = 0; p < start.size(); ++p)
    EXPECT_NEAR(simulation.positions()[p], start[p], 1e-6);
  advance(simulation, 1.5);
  for (std::size_t p = 1; p < start.size(); p += 3)
    EXPECT_GT(simulation.positions()[p], start[p] + 0.5);
}

// Nothing acts on a sheet that flies and spins: its momenta stay, its middle goes straight on.
TEST(ValuesOverTime, SpinAndVelocityAreKept) {
  for (const Method method : {Method::spring, Method::compliant})
    for (const Vec3 spin : {Vec3{0, 3, 0}, Vec3{0, 0, 2}, Vec3{1, -2, 0.5}}) {
      Scene scene = free_sheet(method, 40);
      scene.cloths[0].particle_mass = 0.002;
      scene.cloths[0].velocity = {0.3, -0.2, 0.1};
      scene.cloths[0].spin = spin;
      Simulation simulation(scene);
      const std::vector<double> start = simulation.positions();
      const Report before = simulation.report();
      // Σ m r × (ω × r) in closed form over the grid: I about the plane's axes.
      double along = 0;
      for (int i = 0; i < 9; ++i) along += 9 * 0.002 * std::pow(0.4 * (i / 8.0 - 0.5), 2);
      const Vec3 momentum{0.002 * 81 * 0.3, 0.002 * 81 * -0.2, 0.002 * 81 * 0.1};
      const Vec3 middle{0.3, 0.2, 0.1};
      const Vec3 orbit{middle[1] * momentum[2] - middle[2] * momentum[1],
                       middle[2] * momentum[0] - middle[0] * momentum[2],
                       middle[0] * momentum[1] - middle[1] * momentum[0]};
      const Vec3 own{along * spin[0], 2 * along * spin[1], along * spin[2]};
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(before.momentum[k], momentum[k], 1e-7);
        EXPECT_NEAR(before.angular_momentum[k], orbit[k] + own[k], 1e-7);
      }
      advance(simulation, 1);
      const Report after = simulation.report();
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(after.momentum[k], momentum[k], 1e-5);
        // The compliant method damps the stretch that the spin brings.
        EXPECT_NEAR(after.angular_momentum[k], orbit[k] + own[k],
                    (method == Method::spring ? 2e-4 : 1e-2) * length_of(own) + 1e-6)
            << int(method);
      }
      double sum = 0;
      const std::vector<double> x = simulation.positions();
      for (std::size_t p = 0; p < x.size(); p += 3) sum += x[p] - start[p];
      EXPECT_NEAR(sum / 81, 0.3, 1e-4);
    }
}

TEST(ValuesOverTime, PinsTurnAboutTheirAxis) {
  for (const Method method : kMethods) {
    Scene scene = free_sheet(method, 20);
    Pin pin{0, 0, {}, {{0, 0, 2}, {0.5, 0.2, 0}, {{0, 0}, {1, 180}, {2, 90}}}, -1};
    scene.cloths[0].pins.push_back(pin);
    Simulation simulation(scene);
    const Vec3 start = at(simulation.positions(), 0);
    for (int frame = 0; frame < 150; ++frame) {
      simulation.advance_frame();
      const double t = simulation.time();
      const double degrees = t < 1 ? 180 * t : t < 2 ? 180 - 90 * (t - 1) : 90;
      const double a = degrees * std::numbers::pi / 180;
      const double x = start[0] - 0.5, y = start[1] - 0.2;
      const Vec3 now = at(simulation.positions(), 0);
      ASSERT_NEAR(now[0], 0.5 + x * std::cos(a) - y * std::sin(a), 1e-6);
      ASSERT_NEAR(now[1], 0.2 + x * std::sin(a) + y * std::cos(a), 1e-6);
      ASSERT_NEAR(now[2], start[2], 1e-6);
    }
  }
}

// A pin goes where the collider goes, from where it starts, moved by keys or by hand.
TEST(ValuesOverTime, PinsFollowTheirCollider) {
  for (const bool far : {false, true}) {
    Scene scene = free_sheet(Method::spring, 20);
    scene.colliders.push_back(collider_of(Sphere{{5, 5, 5}, 0.1}));
    scene.colliders[0].keys = {{0, {4, 5, 5}}, {0.5, {4, 5.5, 4.8}}};
    scene.cloths[0].pins.push_back({3, 4, {}, {}, 0});
    if (far) scene = moved(scene, {1000, 0, 0});
    Simulation simulation(scene);
    const std::size_t p = 4 * 9 + 3;
    const Vec3 start = at(simulation.positions(), p);
    EXPECT_NEAR(start[1], 0.2, 1e-6);
    advance(simulation, 0.25);
    EXPECT_NEAR(at(simulation.positions(), p)[1], start[1] + 0.25, 1e-6);
    EXPECT_NEAR(at(simulation.positions(), p)[2], start[2] - 0.1, 1e-6);
    advance(simulation, 0.6);
    const double x = far ? 1000 : 0;
    simulation.move_collider(0, {x + 4.1, 5.5, 4.8});
    simulation.advance_frame();
    simulation.advance_frame();
    EXPECT_NEAR(at(simulation.positions(), p)[0], start[0] + 0.1, 1e-4);
    EXPECT_NEAR(at(simulation.positions(), p)[1], start[1] + 0.5, 1e-4);
  }
}

TEST(ValuesOverTime, ThePlanTellsOfThem) {
  Scene scene = free_sheet(Method::spring, 8);
  const auto told = [](const Scene& s) { return to_text(Simulation(s).plan()); };
  EXPECT_EQ(told(scene).find("keys"), std::string::npos);
  scene.wind.drag = 0.5;
  scene.gravity_keys = {{0.5, {0, 0, 0}}, {2, {0, -5, 0}}};
  scene.wind.velocity_keys = {{0, {1, 0, 0}}};
  EXPECT_NE(told(scene).find("gravity follows its keys from 0.5 to 2 s"), std::string::npos);
  EXPECT_NE(told(scene).find("drag and lift of triangles, along keys"), std::string::npos);
}

TEST(ValuesOverTime, AreReadAndWritten) {
  const char* text = R"({"weft": 1, "gravity": {"keys": [[0, 0,0,0], [1, 0,-9.81,0]]},
    "wind": {"velocity": {"keys": [[0, 1,2,3]]}, "drag": 1},
    "cloths": [{"grid": {"points": [4, 4]}, "velocity": [1,2,3], "spin": [0,0,1],
      "pins": [[0,0], {"at": [1,0], "rotate": {"axis": [0,0,1], "about": [1,0,0], "keys": [[0, 0], [1, 90]]}},
               {"at": [2,0], "follow": 0}]}],
    "colliders": [{"sphere": {"center": [0,-2,0]}}]})";
  const SceneFile file = read_scene_text(text);
  ASSERT_TRUE(file.faults.empty()) << file.faults[0].place << ' ' << file.faults[0].what;
  EXPECT_EQ(file.scene.gravity_keys.size(), 2u);
  EXPECT_EQ(file.scene.wind.velocity_keys[0].position, (Vec3{1, 2, 3}));
  EXPECT_EQ(file.scene.cloths[0].pins[1].rotate.keys[1].degrees, 90);
  EXPECT_EQ(file.scene.cloths[0].pins[2].follow, 0);
  EXPECT_EQ(read_scene_text(write_scene_text(file.scene)).scene, file.scene);
}

TEST(ValuesOverTime, FaultsAreNamed) {
  const auto place = [](const std::string& keys) {
    const SceneFile file =
        read_scene_text(R"({"weft": 1, )" + keys + R"("colliders": [{"sphere": {}}]})");
    return file.faults.empty() ? std::string("none") : file.faults[0].place;
  };
  const auto cloth = [](const std::string& inner) {
    return R"("cloths": [{"grid": {"points": [4, 4]}, )" + inner + "}], ";
  };
  EXPECT_EQ(place(R"("gravity": {"keys": [[1, 0,0,0], [1, 0,0,0]]}, )" + cloth(R"("level": 0)")),
            "/gravity/keys/1");
  EXPECT_EQ(place(R"("gravity": {"keys": []}, )" + cloth(R"("level": 0)")), "/gravity/keys");
  EXPECT_EQ(place(R"("gravity": {"keys": [[0, 0,1e9,0]]}, )" + cloth(R"("level": 0)")),
            "/gravity/keys/0/2");
  EXPECT_EQ(place(cloth(R"("velocity": [0, 2000, 0])")), "/cloths/0/velocity/1");
  EXPECT_EQ(place(cloth(R"("pins": [{"at": [0,0], "follow": 1}])")), "/cloths/0/pins/0/follow");
  EXPECT_EQ(place(cloth(R"("pins": [{"at": [0,0], "follow": -2}])")), "/cloths/0/pins/0/follow");
  EXPECT_EQ(place(cloth(R"("pins": [{"at": [0,0], "rotate": {"axis": [0,0,0]}}])")),
            "/cloths/0/pins/0/rotate/axis");
  EXPECT_EQ(place(cloth(R"("pins": [{"at": [0,0], "rotate": {"keys": [[0, 1], [0, 2]]}}])")),
            "/cloths/0/pins/0/rotate/keys/1");
}

}  // namespace
}  // namespace weft
