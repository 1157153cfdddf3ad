// Parts of a scene: added, copied, turned, sized, taken away (parts.h).
#include "edit/parts.h"

#include <algorithm>
#include <cmath>

#include "edit/cloth_place.h"
#include "weft/mesh.h"
#include "weft/shape.h"
#include "weft/turn.h"

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
  copy.rotate.about = plus(copy.rotate.about, by);
  return copy;
}

}  // namespace

Scene with_body(Scene scene, const Shape& shape, const Vec3& at, double size) {
  Collider body;
  body.shape = moved(shape, at);
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
  cloth.density = area_density(like);
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
  const Vec3 place = place_of(shape);
  return weft::turned(std::move(shape), rotation(axis, angle), place);
}

Shape sized(Shape shape, double factor) {
  const Vec3 place = place_of(shape);
  for_each_value(shape, [&](const char*, auto& value, ShapeValue is) {
    if constexpr (std::is_same_v<decltype(value), Vec3&>) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (is == ShapeValue::point) value[k] = place[k] + factor * (value[k] - place[k]);
        if (is == ShapeValue::length) value[k] *= factor;
      }
    } else {
      value *= factor;
    }
  });
  return shape;
}

bool can_turn(const Shape& shape) {
  bool can = false;
  for_each_value(shape, [&](const char*, const auto&, ShapeValue is) {
    can = can || is == ShapeValue::point || is == ShapeValue::direction || is == ShapeValue::angles;
  });
  return can;
}
bool can_size(const Shape& shape) {
  bool can = false;
  for_each_value(shape, [&](const char*, const auto&, ShapeValue is) {
    can = can || is == ShapeValue::length || is == ShapeValue::radius;
  });
  return can;
}

}  // namespace weft::viewer
