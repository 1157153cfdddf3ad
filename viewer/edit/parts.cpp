// Parts of a scene: added, copied, turned, sized, taken away (parts.h).
#include "edit/parts.h"

#include <algorithm>
#include <cmath>

#include "edit/cloth_place.h"
#include "edit/turn.h"
#include "weft/mesh.h"
#include "weft/shape.h"

namespace weft::viewer {

namespace {

// How wide points are along x, or along z where that is more.
Vec3 beside(const std::vector<Vec3>& points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points)
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  const double x = high[0] - low[0], z = high[2] - low[2];
  constexpr double kGap = 1.15;
  return x >= z ? Vec3{kGap * x, 0, 0} : Vec3{0, 0, kGap * z};
}

void shift(std::vector<Key>& keys, const Vec3& by) {
  for (Key& key : keys) key.position = plus(key.position, by);
}

Cloth copy_of(const Cloth& cloth) {
  const Grid& g = cloth.grid;
  return moved(cloth, cloth.mesh.given()
                          ? beside(placed_vertices(cloth.mesh))
                          : beside({g.origin, plus(g.origin, g.u), plus(g.origin, g.v),
                                    plus(plus(g.origin, g.u), g.v)}));
}

Collider copy_of(const Collider& body) {
  Collider copy = body;
  const Vec3 by = beside(triangulate(body.shape).positions);
  copy.shape = moved(body.shape, by);
  shift(copy.keys, by);
  return copy;
}

// kg/m²
double density_of(const Cloth& cloth) {
  if (cloth.mesh.given() || (cloth.particle_mass == 0 && cloth.masses.empty()))
    return cloth.density;
  const Grid& g = cloth.grid;
  return particle_mass(cloth, g.nx / 2, g.ny / 2) / (spacing_u(g) * spacing_v(g));
}

Shape made(std::size_t shape, const Vec3& at, double size) {
  const double r = size / 2;
  const Vec3 low = plus(at, {0, -r, 0}), high = plus(at, {0, r, 0});
  const Shape all[] = {Sphere{at, r}, Plane{low, {0, 1, 0}}, Capsule{low, high, r / 2},
                       Box{at, {r, r, r}, {}, r / 10}, Cylinder{low, high, r, r / 10}};
  return all[shape];
}

}  // namespace

Scene with_body(Scene scene, std::size_t shape, const Vec3& at, double size) {
  Collider body;
  body.shape = made(shape, at, size);
  body.friction = {FrictionModel::coulomb, 0.3, 0.3};
  body.offset = 0.01 * size;
  scene.colliders.push_back(body);
  return scene;
}

Scene with_cloth(Scene scene, const Vec3& at, double size) {
  Cloth cloth = scene.cloths.front();
  cloth.mesh = {};
  cloth.sewing = false;
  cloth.seams.clear();
  cloth.pressure = {};
  cloth.grid = {32, 32, plus(at, {-size / 2, 0, -size / 2}), {size, 0, 0}, {0, 0, size}, 0};
  cloth.pins.clear();
  cloth.cuts.clear();
  cloth.masses.clear();
  cloth.velocity = cloth.spin = {};
  scene.cloths.push_back(std::move(cloth));
  return scene;
}

// What a mesh cannot have is left at its standard value; a method that cannot move meshes gives way to one
// that is near it.
Scene with_mesh(Scene scene, Kind kind, const MeshSource& mesh) {
  if (kind == Kind::body) {
    Collider body;
    MeshBody shape;
    static_cast<MeshSource&>(shape) = mesh;
    body.shape = std::move(shape);
    body.friction = {FrictionModel::coulomb, 0.3, 0.3};
    body.offset = 0.1 * mean_edge(mesh);
    scene.colliders.push_back(std::move(body));
    return scene;
  }
  const Cloth& like = scene.cloths.front();
  Cloth cloth;
  static_cast<MeshSource&>(cloth.mesh) = mesh;
  cloth.density = density_of(like);
  cloth.stiffness.structural = like.stiffness.structural;
  cloth.bending = like.bending;
  cloth.drag = like.drag;
  cloth.self_collision = like.self_collision;
  cloth.self_collision.response = SelfCollisionResponse::stiff;
  constexpr double kThickest = 0.5;  // mean edges
  cloth.self_collision.thickness =
      std::min(cloth.self_collision.thickness, kThickest * mean_edge(mesh));
  scene.cloths.push_back(std::move(cloth));
  if (scene.solver.method == Method::positional) scene.solver.method = Method::compliant;
  if (scene.solver.sweep == Sweep::jacobi) scene.solver.sweep = Sweep::gauss_seidel;
  return scene;
}

Scene with_copy(Scene scene, const Part& part) {
  if (part.kind == Kind::cloth)
    scene.cloths.push_back(copy_of(scene.cloths[part.number]));
  else
    scene.colliders.push_back(copy_of(scene.colliders[part.number]));
  return scene;
}

Scene without(Scene scene, const Part& part) {
  const auto at = static_cast<std::ptrdiff_t>(part.number);
  if (part.kind == Kind::cloth) {
    scene.cloths.erase(scene.cloths.begin() + at);
    return scene;
  }
  scene.colliders.erase(scene.colliders.begin() + at);
  for (Cloth& cloth : scene.cloths)
    for (Pin& pin : cloth.pins) {
      if (pin.follow == at) pin.follow = -1;
      if (pin.follow > at) --pin.follow;
    }
  return scene;
}

Shape turned(Shape shape, std::size_t axis, double angle) {
  const Matrix turn = rotation(axis, angle);
  const auto about = [&](const Vec3& p, const Vec3& place) {
    return plus(place, times(turn, Vec3{p[0] - place[0], p[1] - place[1], p[2] - place[2]}));
  };
  if (auto* plane = std::get_if<Plane>(&shape)) plane->normal = times(turn, plane->normal);
  if (auto* box = std::get_if<Box>(&shape))
    box->rotation = angles_of(times(turn, matrix_of(box->rotation)));
  if (auto* mesh = std::get_if<MeshBody>(&shape))
    mesh->rotate = angles_of(times(turn, matrix_of(mesh->rotate)));
  if (auto* capsule = std::get_if<Capsule>(&shape)) capsule->b = about(capsule->b, capsule->a);
  if (auto* cylinder = std::get_if<Cylinder>(&shape)) cylinder->b = about(cylinder->b, cylinder->a);
  return shape;
}

Shape sized(Shape shape, double factor) {
  const auto longer = [&](const Vec3& a, Vec3& b) {
    for (std::size_t k = 0; k < 3; ++k) b[k] = a[k] + factor * (b[k] - a[k]);
  };
  if (auto* sphere = std::get_if<Sphere>(&shape)) sphere->radius *= factor;
  if (auto* mesh = std::get_if<MeshBody>(&shape)) mesh->scale *= factor;
  if (auto* capsule = std::get_if<Capsule>(&shape))
    longer(capsule->a, capsule->b), capsule->radius *= factor;
  if (auto* cylinder = std::get_if<Cylinder>(&shape)) {
    longer(cylinder->a, cylinder->b);
    cylinder->radius *= factor;
    cylinder->rounding *= factor;
  }
  if (auto* box = std::get_if<Box>(&shape)) {
    for (double& half : box->half) half *= factor;
    box->rounding *= factor;
  }
  return shape;
}

bool can_turn(const Shape& shape) {
  return !std::holds_alternative<Sphere>(shape);
}
bool can_size(const Shape& shape) {
  return !std::holds_alternative<Plane>(shape);
}

}  // namespace weft::viewer
