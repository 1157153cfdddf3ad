// Colliders as geometry: distances, normals and triangles agree with each other and with the
// kernels.
#include <map>
#include <random>

#include "contact_scenes.h"
#include "physics/contact/colliders/shapes.h"

namespace weft {
namespace {

using physics::nearest_of;

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all = {
      Sphere{{0.1, 0.2, -0.1}, 0.4},
      Plane{{0, 0.1, 0}, {0.3, 2, -0.4}},
      Capsule{{-0.3, 0, 0.1}, {0.4, 0.2, 0}, 0.2},
      Box{{0.05, 0, 0}, {0.3, 0.2, 0.4}, {20, -35, 50}, 0},
      Box{{0.05, 0, 0}, {0.3, 0.2, 0.4}, {20, -35, 50}, 0.07},
      Cylinder{{-0.3, 0, 0.1}, {0.4, 0.2, 0}, 0.25, 0},
      Cylinder{{-0.3, 0, 0.1}, {0.4, 0.2, 0}, 0.25, 0.1},
      Cylinder{{0, 0, 0}, {0.02, 0.06, 0}, 0.4, 0.02},
      TaperedCapsule{{-0.3, 0, 0.1}, {0.4, 0.2, 0}, 0.3, 0.1},
      TaperedCapsule{{-0.3, 0, 0.1}, {0.4, 0.2, 0}, 0.02, 0.4},
      TaperedCapsule{{0.1, 0, 0.1}, {0.2, 0.1, 0}, 0.4, 0.1},  // the one ball within the other
      TaperedCapsule{{0.1, 0, 0.1}, {0.2, 0.1, 0}, 0.1, 0.4},
  };
  return all;
}

std::vector<Vec3> random_points(int count, double size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-size, size);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = {within(random), within(random), within(random)};
  return points;
}

TEST(ContactShapes, NormalIsTheGradientOfTheDistance) {
  for (const Shape& shape : shapes())
    for (const Vec3& p : random_points(500, 1)) {
      std::visit(
          [&](const auto& s) {
            const physics::Nearest here = nearest_of(s, p);
            constexpr double h = 1e-6;
            double kink = 0;  // the gradient jumps where two sides are equally near
            for (int k = 0; k < 3; ++k) {
              Vec3 up = p, down = p;
              up[k] += h;
              down[k] -= h;
              const double slope =
                  (nearest_of(s, up).distance - nearest_of(s, down).distance) / (2 * h);
              kink = std::max(kink, std::abs(slope - here.normal[k]));
            }
            EXPECT_LT(kink, 1e-5) << shape.index();
            EXPECT_NEAR(dot(here.normal, here.normal), 1, 1e-12);
          },
          shape);
    }
}

double volume_of(const Shape& shape) {
  if (const auto* s = std::get_if<Sphere>(&shape)) return 4 / 3. * M_PI * std::pow(s->radius, 3);
  if (const auto* c = std::get_if<Capsule>(&shape)) {
    const double r = c->radius, l = std::sqrt(0.7 * 0.7 + 0.2 * 0.2 + 0.1 * 0.1);
    return 4 / 3. * M_PI * r * r * r + M_PI * r * r * l;
  }
  if (const auto* c = std::get_if<TaperedCapsule>(&shape)) {
    // Caps of both balls and the frustum between the circles where they touch the side.
    const Vec3 e = minus(c->b, c->a);
    const double l = length(e), a = c->radius_a, b = c->radius_b;
    if (std::abs(a - b) >= l) return 4 / 3. * M_PI * std::pow(std::max(a, b), 3);
    const double k = (a - b) / l, side = std::sqrt(1 - k * k), height = l + k * (b - a);
    const auto cap = [](double r, double share) {  // of the height (1 + share) r
      return M_PI * std::pow(r * (1 + share), 2) * (3 * r - r * (1 + share)) / 3;
    };
    return cap(a, k) + cap(b, -k) + M_PI / 3 * height * side * side * (a * a + a * b + b * b);
  }
  if (const auto* c = std::get_if<Cylinder>(&shape)) {
    const Vec3 e = minus(c->b, c->a);
    const double r = c->rounding, big = c->radius - r, l = length(e) - 2 * r;
    // Steiner's formula of the core: volume, surface, mean width.
    return M_PI * big * big * l + (2 * M_PI * big * big + 2 * M_PI * big * l) * r +
           (M_PI * M_PI * big + M_PI * l) * r * r + 4 / 3. * M_PI * r * r * r;
  }
  const auto& b = std::get<Box>(shape);
  const double r = b.rounding, x = b.half[0] - r, y = b.half[1] - r, z = b.half[2] - r;
  return 8 * x * y * z + 8 * r * (x * y + y * z + z * x) + 2 * M_PI * r * r * (x + y + z) +
         4 / 3. * M_PI * r * r * r;
}

TEST(ContactShapes, TrianglesCloseTheSurface) {
  for (const Shape& shape : shapes()) {
    const ShapeMesh mesh = triangulate(shape);
    Collider collider;
    collider.shape = shape;
    double volume = 0, greatest = 0;
    for (const Vec3& p : mesh.positions)
      greatest = std::max(greatest, std::abs(signed_distance(collider, 0, p)));
    EXPECT_LT(greatest, 1e-9) << shape.index();
    for (const auto& t : mesh.triangles) {
      const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const Vec3 u = minus(b, a), v = minus(c, a);
      const Vec3 n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
      EXPECT_GE(dot(n, mesh.normals[t[0]]), -1e-12) << shape.index();
      volume += dot(n, a) / 6;
    }
    if (std::holds_alternative<Plane>(shape)) continue;
    EXPECT_NEAR(volume / volume_of(shape), 1, 0.01) << shape.index();
  }
}

// Loose particles that lie so are all lifted out of a shape in one substep, the shortest way to a tolerance [m], by
// the kernels of every instruction set alike.
void expect_lifted_out(const Shape& shape, const std::vector<Vec3>& points, double tolerance) {
  std::uint64_t hash = 0;
  for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512}) {
    if (!simd_available(simd)) continue;
    Scene scene;
    scene.gravity = {0, 0, 0};
    scene.time.substeps = 1;
    scene.cloths.push_back(loose_particles({0, 0, 0}));
    scene.cloths[0].grid.nx = scene.cloths[0].grid.ny = 23;
    scene.cloths[0].grid.origin = {0, 10, 0};  // what starts inside is moved out slowly
    scene.colliders.push_back(collider_of(shape));
    scene.colliders[0].offset = 0.01;
    Simulation simulation(scene, {1, simd, 1, false});
    std::vector<double> x, v(3 * points.size());
    for (const Vec3& p : points) x.insert(x.end(), p.begin(), p.end());
    simulation.set_state(x, v);
    simulation.advance_frame();
    const std::vector<double> after = simulation.positions();
    for (std::size_t p = 0; p < points.size(); ++p) {
      const double before = signed_distance(scene.colliders[0], 0, points[p]);
      const Vec3 moved = minus(at(after, p), points[p]);
      EXPECT_NEAR(length(moved), std::max(0.0, 0.01 - before), tolerance);
      EXPECT_GT(signed_distance(scene.colliders[0], 0, at(after, p)), 0.01 - tolerance);
    }
    if (hash == 0) hash = simulation.hash();
    EXPECT_EQ(simulation.hash(), hash) << simd_name(simd);
  }
}

TEST(ContactShapes, KernelsLiftParticlesOutTheShortestWay) {
  for (const Shape& shape : shapes()) expect_lifted_out(shape, random_points(23 * 23, 0.6), 1e-6);
}

// On the axis of a round shape no side is nearer than others; what rounding leaves across it is no direction.
// `lean`: of the side's normals along the axis, a sine.
template <class Rod>
void expect_straight_out(const Rod& rod, double lean) {
  const Vec3 e = minus(rod.b, rod.a), axis = times(e, 1 / length(e));
  std::vector<Vec3> points;
  for (int n = 0; n < 23 * 23; ++n) {
    const Vec3 along = times(e, 0.1 + 0.8 * n / (23 * 23));
    EXPECT_NEAR(dot(nearest_of(rod, along).normal, axis), lean, 1e-9);
    points.push_back(plus(rod.a, along));
  }
  expect_lifted_out(rod, points, 1e-5);
}

TEST(ContactShapes, TheAxisOfARoundShapeLeadsOutStraight) {
  for (const Vec3& way : random_points(20, 1)) {
    const Vec3 axis = times(way, 1 / length(way));
    const Vec3 a{-0.3, 0, 0.1}, b = plus(a, times(axis, 0.6));
    const Cylinder rod{a, b, 0.02, 0.001};
    expect_straight_out(rod, 0);
    expect_straight_out(Capsule{a, b, 0.02}, 0);
    expect_straight_out(TaperedCapsule{a, b, 0.02, 0.08}, -0.1);
    expect_straight_out(TaperedCapsule{a, b, 0.05, 0.02}, 0.05);
    for (const double end : {0.0, 1.0}) {
      const Vec3 furthest = physics::support_of(rod, times(axis, 2 * end - 1));
      EXPECT_NEAR(nearest_of(rod, furthest).distance, -rod.rounding, 1e-12);
    }
  }
}

TEST(ContactShapes, KeysMoveAnyShape) {
  for (const Shape& shape : shapes()) {
    Collider c;
    c.shape = shape;
    const Vec3 place = std::visit([](const auto& s) { return physics::place_of(s); }, shape);
    c.keys = {{0, place}, {2, {place[0] + 1, place[1] - 2, place[2]}}};
    EXPECT_NEAR(displacement(c, 1)[0], 0.5, 1e-12);
    EXPECT_NEAR(displacement(c, 1)[1], -1, 1e-12);
    Collider still = c;
    still.keys.clear();
    EXPECT_NEAR(signed_distance(c, 1, {0.7, 0.1, 0.3}), signed_distance(still, 0, {0.2, 1.1, 0.3}),
                1e-12);
  }
}

}  // namespace
}  // namespace weft
