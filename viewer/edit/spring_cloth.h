// Seed 000's parameters by its own names, as they stand in a scene, and put back into one.
#pragma once

#include "edit/document.h"

namespace weft::viewer {

struct SpringCloth {
  int cloth_dim = 30;             // particles a side
  double particle_offset = 0.15;  // m, between neighbours
  double particle_mass = 0.1;     // kg
  double gravity = -9.81;         // m/s², upward
  Method type = Method::spring;   // positional, spring, spring_friction
  double k = 15;   // N/m; positional: share of the error that each end takes, 0 … 0.5
  double u = 0.1;  // N·s/m, spring_friction
  int constraint_iterations = 10;
  int constraint_level = 2;
  int collision_iterations = 1;
  double offset_multiplier = 1.15;  // of the spheres' radii
  double cut_length = 0;            // times the rest length; 0: nothing is cut
  friend bool operator==(const SpringCloth&, const SpringCloth&) = default;
};

// Whether a scene has one square cloth with constraints by level, as the seed's.
bool is_spring_cloth(const Scene& scene);

SpringCloth spring_cloth_of(const Scene& scene);

// The scene with other parameters. What is pinned stays pinned at its share of the way along the edges.
Scene with(Scene scene, const SpringCloth& wanted);

// The same as changes of a document.
std::vector<Document::Change> changes_to(const Scene& scene, const SpringCloth& wanted);

}  // namespace weft::viewer
