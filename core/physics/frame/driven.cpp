// What does work on cloths (driven.h).
#include "physics/frame/driven.h"

#include <algorithm>

#include "physics/model/placement.h"

namespace weft::physics {
namespace {

bool blown(const Scene& scene) {
  return scene.wind.drag > 0 || scene.wind.lift > 0;
}

bool sews(const Cloths& cloths) {
  return std::any_of(cloths.begin(), cloths.end(),
                     [](const auto& step) { return step->model().open_seams().open > 0; });
}

// `changing`: by a load that changes over time.
bool loaded(const Cloths& cloths, bool changing) {
  return std::any_of(cloths.begin(), cloths.end(), [&](const auto& step) {
    const Load* load = step->model().load();
    return load && (!changing || load->changes());
  });
}

}  // namespace

bool is_driven(const Scene& scene, const Cloths& cloths) {
  const auto moves = [](const Collider& c) { return moves_rigidly(c) || !c.animation.empty(); };
  const auto pulls = [](const Pin& pin) { return pin.moves(); };
  return !scene.gravity_keys.empty() || blown(scene) || sews(cloths) || loaded(cloths, true) ||
         std::any_of(scene.colliders.begin(), scene.colliders.end(), moves) ||
         std::any_of(scene.cloths.begin(), scene.cloths.end(), [&](const Cloth& c) {
           return std::any_of(c.pins.begin(), c.pins.end(), pulls);
         });
}

bool is_acted_on(const Scene& scene, const Cloths& cloths) {
  return !scene.gravity_keys.empty() || blown(scene) || sews(cloths) || loaded(cloths, false) ||
         !scene.colliders.empty();
}

}  // namespace weft::physics
