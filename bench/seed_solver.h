// Seed 000's own solver, written plainly from its text: single precision, position Verlet at 1/60 s with
// 2 % of velocity damping, constraints in the order of its listing, every constraint iteration adding the
// spring force again, collisions by putting particles out. What it is asked for is typed as it prints it.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "weft/scene.h"

namespace bench {

enum class SeedConstraint { positional, spring, spring_friction };

// The seed's parameters by its names. Where its text leaves a value open, the value is ours.
struct SeedSettings {
  int cloth_dim = 30;
  float particle_offset = 0.15f;  // m
  float particle_mass = 0.1f;     // kg
  float gravity = -9.81f;         // m/s²; open in the text
  SeedConstraint type = SeedConstraint::spring;
  float k = 15, u = 0.1f;
  int constraint_iterations = 10;
  int constraint_level = 2;
  int collision_iterations = 1;     // open
  float offset_multiplier = 1.15f;  // open
  bool pinned = true;               // the upper edge; open
  bool on_sphere = false;           // spawned level, its middle inside of a sphere
};

class SeedSolver {
 public:
  explicit SeedSolver(const SeedSettings& settings);
  void step();  // 1/60 s
  std::size_t constraints() const { return constraints_.size(); }
  // Greatest length of a constraint over its rest length; not finite where a particle is not.
  double stretch() const;
  // Greatest distance from the start's centre [m].
  double spread() const;

 private:
  using Vec = std::array<float, 3>;
  struct Particle {
    Vec pos{}, old_pos{}, force{};
    bool movable = true;
  };
  struct Constraint {
    int p1, p2;
    float rest_distance;
  };
  void make_constraint(int x, int y, int ox, int oy, float rest);
  void satisfy(const Constraint& c);
  void collide(Particle& p) const;

  SeedSettings settings_;
  std::vector<Particle> particles_;
  std::vector<Constraint> constraints_;
  Vec center_{}, sphere_{};
  float radius_ = 0.8f;  // m; open
};

// The same settings as a scene of Weft's, with the seed's meaning of everything.
weft::Scene scene_of(const SeedSettings& settings);

}  // namespace bench
