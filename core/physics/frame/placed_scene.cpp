// Scenes about an origin (placed_scene.h), and moving scenes.
#include "physics/frame/placed_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "physics/contact/colliders/shapes.h"
#include "physics/frame/projection_substep.h"

namespace weft {

using namespace physics;

Scene moved(Scene scene, const Vec3& by) {
  const auto move = [&](Vec3& p) { p = plus(p, by); };
  for (Cloth& cloth : scene.cloths) {
    move(cloth.grid.origin);
    if (cloth.mesh.given()) move(cloth.mesh.translate);
    for (Pin& pin : cloth.pins) {
      if (!pin.of_several())
        for (Key& key : pin.keys) move(key.position);
      if (pin.box)
        for (Vec3& corner : *pin.box) move(corner);
      if (!pin.rotate.keys.empty()) move(pin.rotate.about);
    }
  }
  for (Collider& collider : scene.colliders) {
    collider.shape = moved(collider.shape, by);
    for (Key& key : collider.keys) move(key.position);
    if (!collider.rotate.keys.empty()) move(collider.rotate.about);
  }
  return scene;
}

namespace physics {

Vec3 origin_of(const Scene& scene) {
  constexpr double kNear = 1;  // m
  Vec3 low, high, middle;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  const auto cover = [&](const Vec3& corner) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], corner[k]);
      high[k] = std::max(high[k], corner[k]);
    }
  };
  for (const Cloth& cloth : scene.cloths) {
    const Grid& g = cloth.grid;
    if (cloth.mesh.given())
      for (const Vec3& p : placed_vertices(cloth.mesh)) cover(p);
    for (const double a : {0, 1})
      for (const double b : {0, 1})
        if (!cloth.mesh.given()) cover(plus(g.origin, plus(times(g.u, a), times(g.v, b))));
  }
  bool near = true;
  for (int k = 0; k < 3; ++k) {
    middle[k] = std::round((low[k] + high[k]) / 2);
    near &= std::abs(middle[k]) <= kNear;
  }
  return near ? Vec3{} : middle;
}

namespace {

bool holds_several(const Scene& scene) {
  return std::any_of(scene.cloths.begin(), scene.cloths.end(), [](const Cloth& c) {
    return std::any_of(c.pins.begin(), c.pins.end(), [](const Pin& p) { return p.of_several(); });
  });
}

}  // namespace

PlacedScene::PlacedScene(Scene scene, const Vec3& origin) : origin_(origin) {
  if (origin_ != Vec3{} || holds_several(scene)) given_ = scene;
  for (Cloth& cloth : scene.cloths) cloth.pins = single_pins(cloth);
  simulated_ = origin_ == Vec3{} ? std::move(scene) : moved(std::move(scene), times(origin_, -1));
}

void PlacedScene::set_path(std::size_t collider, std::vector<Key> keys) {
  if (given_) given_->colliders[collider].keys = keys;
  for (Key& key : keys) key.position = minus(key.position, origin_);
  simulated_.colliders[collider].keys = std::move(keys);
}

void PlacedScene::set_solver(const Solver& solver) {
  simulated_.solver = solver;
  if (given_) given_->solver = solver;
}

void PlacedScene::draw_as(const Scene& scene) {
  weft::draw_as(scene, simulated_);
  if (given_) weft::draw_as(scene, *given_);
}

std::string PlacedScene::steady() {
  const std::string changed = steady_jacobi(simulated_);
  if (given_) given_->solver = simulated_.solver;
  return changed;
}

}  // namespace physics
}  // namespace weft
