// One small scene for each thing that can act on a sheet, for tests of what holds for all of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "contact_scenes.h"

namespace weft {

struct Feature {
  std::string name;
  std::function<void(Scene&)> set;
  std::function<void(Simulation&)> begin = [](Simulation&) {};  // a hand, before the first frame
};

inline constexpr int kFeatureSide = 12;  // particles

// A sheet of half a meter that hangs by two corners.
inline Scene hanging_sheet() {
  Scene scene;
  scene.time.substeps = 64;
  scene.cloths.push_back(flat_sheet(kFeatureSide, 0.5, {0.25, 0, 0.25}));
  Cloth& cloth = scene.cloths[0];
  cloth.density = 0.3;
  cloth.stiffness = {100, 50, 20};
  cloth.pins = {{0, 0, {}}, {kFeatureSide - 1, 0, {}}};
  return scene;
}

// A second sheet that falls on the first, which is held at its corners.
inline void drop_a_sheet(Scene& scene, SelfCollisionMode mode, double thickness) {
  constexpr int last = kFeatureSide - 1;
  Cloth& held = scene.cloths[0];
  held.pins = {{0, 0, {}}, {last, 0, {}}, {0, last, {}}, {last, last, {}}};
  held.self_collision = {mode, thickness, 0.5};
  held.drag = 1;
  Cloth falls = held;
  falls.pins.clear();
  falls.grid.origin = {0.015625, 0.09375, 0.03125};
  scene.cloths.push_back(falls);
}

inline std::vector<Feature> features() {
  const auto body = [](Shape shape, double friction, std::vector<Key> keys = {}) {
    return [=](Scene& scene) {
      scene.cloths[0].drag = 2;
      scene.colliders.push_back(collider_of(shape, friction));
      scene.colliders[0].keys = keys;
    };
  };
  const Sphere ball{{0.25, -0.25, 0.3125}, 0.15625};
  return {
      {"nothing but gravity", [](Scene&) {}},
      {"drag", [](Scene& s) { s.cloths[0].drag = 3; }},
      {"unequal masses",
       [](Scene& s) {
         for (int p = 0; p < kFeatureSide * kFeatureSide; ++p)
           s.cloths[0].masses.push_back(0.0003 * (1 + p % 5));
       }},
      {"stiffness gradient", [](Scene& s) { s.cloths[0].stiffness_gradient = 0.75; }},
      {"level 3", [](Scene& s) { s.cloths[0].level = 3; }},
      {"flexural rigidity", [](Scene& s) { s.cloths[0].bending = 0.001; }},
      {"wind",
       [](Scene& s) {
         s.wind = {{3, 1, 4}, 0.6, 0.3, 0};
       }},
      {"pin on a path",
       [](Scene& s) {
         s.cloths[0].pins[0].keys = {
             {0, {0, 0, 0}}, {0.25, {0.125, 0.125, 0}}, {0.5, {0, 0.125, 0.25}}};
       }},
      {"sphere", body(ball, 0)},
      {"sphere, μ = 0.5", body(ball, 0.5)},
      {"rising sphere, μ = 0.5",
       body(ball, 0.5, {{0, {0.25, -0.25, 0.3125}}, {0.5, {0.25, 0.125, 0.3125}}})},
      {"capsule, μ = 0.5", body(Capsule{{0, -0.1875, 0.3125}, {0.5, -0.25, 0.3125}, 0.0625}, 0.5)},
      {"small sphere, μ = 0.5", body(Sphere{{0.2578125, -0.1875, 0.3125}, 0.015625}, 0.5)},
      {"free on a slope, μ = 0.2",
       [](Scene& s) {
         s.cloths[0].pins.clear();
         s.colliders.push_back(collider_of(Plane{{0, -0.125, 0}, {0.3, 1, 0}}, 0.2));
       }},
      {"strain limit", [](Scene& s) { s.cloths[0].strain_limit = 0.0625; }},
      {"tearing",
       [](Scene& s) {
         s.cloths[0].lumping = Lumping::equal;
         s.cloths[0].tear_strain = 0.1;
       }},
      {"tearing, by area", [](Scene& s) { s.cloths[0].tear_strain = 0.1; }},
      {"two sheets, particles",
       [](Scene& s) { drop_a_sheet(s, SelfCollisionMode::particles, 0.046875); }},
      {"two sheets, surface",
       [](Scene& s) { drop_a_sheet(s, SelfCollisionMode::surface, 0.01171875); }},
      {"pull", [](Scene&) {},
       [](Simulation& s) {
         s.grab(0, particle_number(s.scene().cloths[0].grid, 6, 8), {0.3125, -0.0625, 0.3125}, 3);
       }},
      {"carried pins", [](Scene&) {},
       [](Simulation& s) {
         s.carry(0, {0.5, 0.25, 0});
       }},
  };
}

// Where all particles are in the end, after half a second [m].
inline std::vector<double> half_a_second(const Scene& scene, const Feature& feature) {
  Simulation simulation(scene);
  feature.begin(simulation);
  advance(simulation, 0.5);
  EXPECT_FALSE(simulation.plan().fallback) << feature.name;
  return simulation.positions();
}

// Root of the mean squared distance of particles [m].
inline double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum / (double(a.size()) / 3));
}

}  // namespace weft
