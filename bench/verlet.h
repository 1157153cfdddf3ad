// Velocity Verlet in double precision on one sheet (reference.h says what for).
#pragma once

#include <cstdint>
#include <vector>

#include "held.h"
#include "weft/scene.h"

namespace bench {

// Springs that share an offset on the grid: constraint a of row j joins columns a+near of row j and
// a+far of row j+dj.
struct Springs {
  int near, far, dj, count;
  double rest;                    // m
  std::vector<double> stiffness;  // N/m, of every row
  std::vector<double> share;      // of it, of every constraint of a row
};

class Verlet {
 public:
  explicit Verlet(const weft::Scene& scene);

  // Advances `steps` equal steps over `seconds`.
  void advance(double seconds, std::int64_t steps);
  // Damps the motion until the largest acceleration is below `acceleration` [m/s²].
  void come_to_rest(double acceleration);

  // A step that is stable for certain [s]: Gershgorin's bound on the largest frequency.
  double safe_step() const;
  std::vector<double> positions() const;

 private:
  void forces();
  void spring_forces(const Springs& springs);
  void membrane_forces();
  void bending_forces();
  // Calls visit(weights, count, particles, stiffness) for all curvatures: of the energy stiffness |Σ w x|²/2.
  template <class Visit>
  void for_each_curvature(Visit&& visit) const;
  void move(double h, double keep);
  // Pins with keys, where they are at `time` [s].
  void move_pins(double time);
  void contact(double h);
  double largest_acceleration() const;

  weft::Scene scene_;
  int columns_, rows_;
  std::size_t particles_;
  std::vector<Springs> springs_;
  std::vector<double> x_, y_, z_, vx_, vy_, vz_, fx_, fy_, fz_;
  std::vector<double> inverse_mass_;  // 1/kg; 0 = pinned
  std::vector<Held> moved_;           // by keys
  std::vector<double> gx_, gy_, gz_;  // m/s²; 0 where pinned
  std::vector<double> ex_, ey_, ez_;  // one row of spring forces
  double hu_ = 0, hv_ = 0;            // m, spacings
};

}  // namespace bench
