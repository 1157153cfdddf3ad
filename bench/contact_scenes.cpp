// The scenes that try contact among sheets (contact_scenes.h).
#include "contact_scenes.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "weft/mesh.h"
#include "weft/read_scene.h"

namespace bench {
namespace {

using weft::Cloth;
using weft::Scene;
using weft::SelfCollisionMode;
using weft::Vec3;

constexpr double kGravity = 9.81;

// A sheet of n x n points between the sides u and v.
Cloth sheet(int n, const Vec3& origin, const Vec3& u, const Vec3& v, double thickness) {
  Cloth c;
  c.grid = {n, n, origin, u, v, 0};
  c.self_collision.mode = SelfCollisionMode::surface;
  c.self_collision.thickness = thickness;
  return c;
}

Cloth ppf_sheet(int n, const Vec3& origin, const Vec3& u, const Vec3& v, double limit) {
  Cloth c = sheet(n, origin, u, v, 1e-3);
  c.density = 1;
  c.stiffness = {1000, 500, 0};
  c.bending = 1e-3;
  c.strain_limit = limit;
  c.self_collision.friction = 0;
  return c;
}

void pin_row(Cloth& c, int row) {
  for (int i = 0; i < c.grid.nx; ++i) c.pins.push_back({i, row, {}});
}

weft::Collider body(weft::Shape shape, double friction, double offset) {
  weft::Collider b;
  b.shape = std::move(shape);
  b.friction = {weft::FrictionModel::coulomb, friction, friction};
  b.offset = offset;
  return b;
}

Scene ppf_hang() {
  Scene s;
  s.time.seconds = 200.0 / 60;
  Cloth c = ppf_sheet(128, {-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, 0.01);
  c.stiffness = {100, 50, 0};
  c.bending = 1e-4;
  c.pins = {{0, 0, {}}, {127, 0, {}}};
  s.cloths.push_back(c);
  s.solver.method = weft::Method::compliant;  // what holds the limit at least cost
  s.solver.sweep = weft::Sweep::line;
  s.solver.tethers = true;
  s.time.substeps = 64;
  s.gravity_keys = {{0, {0, -kGravity, 0}},
                    {1, {0, -kGravity, 0}},
                    {1.35, {0, kGravity, 0}},
                    {2, {0, -kGravity, 0}}};
  return s;
}

Scene ppf_drape() {
  Scene s;
  s.time.seconds = 100.0 / 60;
  for (int k = 0; k < 5; ++k) {
    Cloth c = ppf_sheet(128, {-1, 0.05 * k, -1}, {2, 0, 0}, {0, 0, 2}, 0.05);
    c.pins = {{0, 0, {}}, {127, 0, {}}};
    s.cloths.push_back(c);
  }
  s.colliders.push_back(body(weft::Sphere{{0, -0.55, 0}, 0.5}, 0, 0.5e-3));
  return s;
}

Scene ppf_curtain() {
  Scene s;
  s.time.seconds = 5;
  for (int k = 0; k < 15; ++k) {
    Cloth c = ppf_sheet(64, {-1, 2, 0.25 * k}, {2, 0, 0}, {0, -2, 0}, 0.05);
    pin_row(c, 0);
    s.cloths.push_back(c);
  }
  weft::Collider ball = body(weft::Sphere{{0, 1, -1}, 0.5}, 0, 0.5e-3);
  ball.keys = {{0, {0, 1, -1}}, {5, {0, 1, 7}}};
  s.colliders.push_back(ball);
  return s;
}

// A tube of 20 000 vertices along z, every second ring turned by half a step.
std::shared_ptr<weft::TriangleMesh> tube(int around, int rings, double radius, double length) {
  auto mesh = std::make_shared<weft::TriangleMesh>();
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5 * (j % 2)) / around;
      mesh->vertices.push_back({radius * std::cos(angle), radius * std::sin(angle),
                                length * j / (rings - 1) - length / 2});
    }
  for (int j = 0; j + 1 < rings; ++j)
    for (int i = 0; i < around; ++i) {
      const int next = (i + 1) % around, a = j * around + i, b = j * around + next;
      const int c = a + around, d = (j + 1) * around + next;
      if (j % 2 == 0) {
        mesh->triangles.push_back({a, b, c});
        mesh->triangles.push_back({b, d, c});
      } else {
        mesh->triangles.push_back({a, d, c});
        mesh->triangles.push_back({a, b, d});
      }
    }
  return mesh;
}

// Both ends turn by a whole turn a second, against each other.
Scene ppf_twist() {
  constexpr int kAround = 125, kRings = 160;
  constexpr double kSeconds = 430.0 / 60, kDegrees = 360;
  Scene s;
  s.time.seconds = kSeconds;
  Cloth c;
  c.mesh.shape = tube(kAround, kRings, 0.5, 2);
  c.density = 1;
  c.membrane = {1500, 1500, 500, 500};  // what those springs amount to
  c.bending = 1e-3;
  c.self_collision.mode = SelfCollisionMode::surface;
  c.self_collision.thickness = 1e-3;
  c.self_collision.friction = 0;
  for (const int ring : {0, kRings - 1}) {
    weft::Pin end;
    for (int i = 0; i < kAround; ++i) end.vertices.push_back(ring * kAround + i);
    end.rotate.axis = {0, 0, ring == 0 ? -1.0 : 1.0};
    end.rotate.keys = {{0, 0}, {kSeconds, kDegrees * kSeconds}};
    c.pins.push_back(end);
  }
  s.gravity = {0, 0, 0};
  s.cloths.push_back(c);
  return s;
}

Scene pile() {
  Scene s;
  s.time.seconds = 8;
  for (int k = 0; k < 10; ++k) {
    s.cloths.push_back(
        sheet(33, {0.002 * k, 0.006 * k + 0.003, 0.001 * k}, {0.5, 0, 0}, {0, 0, 0.5}, 0.003));
    s.cloths.back().drag = 2;
  }
  s.colliders.push_back(body(weft::Plane{{0, 0, 0}, {0, 1, 0}}, 0.3, 0.0015));
  return s;
}

Scene layers() {
  Scene s;
  s.time.seconds = 3;
  constexpr int kLayers = 50;
  for (int k = 0; k < kLayers; ++k) {
    s.cloths.push_back(sheet(70, {0, 0.005 * k + 0.002, 0}, {1, 0, 0}, {0, 0, 1}, 0.003));
    s.cloths.back().drag = 2;
  }
  s.colliders.push_back(body(weft::Plane{{0, 0, 0}, {0, 1, 0}}, 0.3, 0.0015));
  weft::Collider press = body(weft::Plane{{0, 0.26, 0}, {0, -1, 0}}, 0.3, 0.0015);
  press.keys = {{0, {0, 0.26, 0}}, {1.5, {0, kLayers * 0.003 + 0.01, 0}}};
  s.colliders.push_back(press);
  return s;
}

// A ring of capsules about the y axis.
Scene ring() {
  Scene s;
  s.time.seconds = 2;
  constexpr int kParts = 12;
  constexpr double kRadius = 0.12, kThick = 0.03;
  const auto at = [](int k) {
    const double angle = 2 * std::numbers::pi * k / kParts;
    return Vec3{kRadius * std::cos(angle), 0, kRadius * std::sin(angle)};
  };
  for (int k = 0; k < kParts; ++k)
    s.colliders.push_back(body(weft::Capsule{at(k), at(k + 1), kThick}, 0.1, 0.001));
  Cloth c = sheet(81, {-0.4, 0.05, -0.4}, {0.8, 0, 0}, {0, 0, 0.8}, 0.002);
  c.drag = 0.5;
  c.bending = 1e-5;
  c.self_collision.friction = 0.1;
  c.pins = {{40, 40, {{0, {0, 0.05, 0}}, {2, {0, -0.9, 0}}}}};
  s.cloths.push_back(c);
  return s;
}

// Two opposite corners are drawn past each other over the sheet, then the other two over those.
Scene double_fold() {
  Scene s;
  s.time.seconds = 3;
  Cloth c = sheet(65, {-0.3, 0.01, -0.3}, {0.6, 0, 0}, {0, 0, 0.6}, 0.003);
  c.drag = 1;
  c.bending = 1e-5;
  const auto over = [](double x, double z, double start, double height) {
    return std::vector<weft::Key>{{start, {x, 0.01, z}},
                                  {start + 0.5, {0.3 * x, 0.35, 0.3 * z}},
                                  {start + 1, {-0.6 * x, height, -0.6 * z}}};
  };
  c.pins = {{0, 0, over(-0.3, -0.3, 0, 0.03)},
            {64, 64, over(0.3, 0.3, 0.5, 0.05)},
            {64, 0, over(0.3, -0.3, 1.2, 0.08)},
            {0, 64, over(-0.3, 0.3, 1.7, 0.1)}};
  s.cloths.push_back(c);
  s.colliders.push_back(body(weft::Plane{{0, 0, 0}, {0, 1, 0}}, 0.4, 0.0015));
  return s;
}

struct Made {
  ContactScene scene;
  std::function<Scene()> make;
};

const std::vector<Made>& made() {
  static const std::vector<Made> all{
      {{"ppf_hang", "one sheet by two corners, gravity turns over and back, limit 1 %"}, ppf_hang},
      {{"ppf_drape", "five sheets over a ball, limit 5 %"}, ppf_drape},
      {{"ppf_curtain", "a ball through fifteen curtains, limit 5 %"}, ppf_curtain},
      {{"ppf_twist", "a tube of 20 000 vertices, its ends turned against each other"}, ppf_twist},
      {{"pile", "ten sheets let fall on a plane"}, pile},
      {{"layers", "fifty layers pressed by a plane"}, layers},
      {{"ring", "a sheet pulled through a ring by its middle"}, ring},
      {{"double_fold", "four corners folded over each other"}, double_fold}};
  return all;
}

constexpr const char* kShipped[] = {"crumple", "fold50", "fold150", "fold316"};

}  // namespace

const std::vector<ContactScene>& contact_scenes() {
  static const std::vector<ContactScene> all = [] {
    std::vector<ContactScene> list;
    for (const Made& m : made()) list.push_back(m.scene);
    for (const char* name : kShipped) list.push_back({name, "shipped"});
    return list;
  }();
  return all;
}

Scene contact_scene(const std::string& name, double jitter) {
  for (const Made& m : made()) {
    if (m.scene.name != name) continue;
    Scene s = m.make();
    s.name = name;
    for (Cloth& c : s.cloths) c.grid.jitter = jitter;
    return s;
  }
  for (const char* shipped : kShipped)
    if (name == shipped) return weft::read_scene(name).scene;
  throw std::invalid_argument("no contact scene '" + name + "'");
}

}  // namespace bench
