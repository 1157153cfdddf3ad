// The scene of a simulation: as it stands, and as it is simulated about an origin.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "weft/scene.h"

namespace weft::physics {

// What the positions of a simulation are counted from. Single precision is fine near zero and coarse
// far away: where points are 1 cm apart it knows strain to 1e-4 at 10 m from zero, and not at all at
// 10 km. So a scene whose cloths start far away is simulated about a point among them: the middle of where
// they start, in whole meters. Zero for cloths near zero.
Vec3 origin_of(const Scene& scene);

class PlacedScene {
 public:
  // `origin`: what positions are counted from [m].
  PlacedScene(Scene scene, const Vec3& origin);
  PlacedScene(const PlacedScene&) = delete;
  PlacedScene& operator=(const PlacedScene&) = delete;

  // About the origin, every pin of one particle. Stays where it is in memory: cloths refer to it.
  const Scene& simulated() const { return simulated_; }
  // Where it was put, with its pins as they were given.
  const Scene& given() const { return given_ ? *given_ : simulated_; }
  const Vec3& origin() const { return origin_; }

  // A collider goes another way, by keys where the scene was put.
  void set_path(std::size_t collider, std::vector<Key> keys);
  void set_solver(const Solver& solver);
  // Takes over what is only drawn (weft::draw_as).
  void draw_as(const Scene& scene);
  // Puts settings in the place of those that are not stable; returns what to tell, "" where nothing changed.
  std::string steady();

 private:
  const Vec3 origin_;
  std::optional<Scene> given_;  // unless it is simulated just so
  Scene simulated_;
};

}  // namespace weft::physics
