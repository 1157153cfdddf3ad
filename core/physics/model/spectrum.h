// What limits the substeps of explicit methods.
#pragma once

namespace weft::physics {

// Leapfrog is stable while dt ω_max < 2; damping along the springs, evaluated at the velocity half a
// substep behind, asks for dt² ω²/4 + dt c/2 < 1.
struct Spectrum {
  double omega_squared = 0;  // 1/s², ω_max²: the largest eigenvalue of M⁻¹K
  double damping = 0;        // 1/s, c: the largest eigenvalue of M⁻¹D
  double load = 0;           // 1/s², what loads add to ω_max² at most
  double drag = 0;           // 1/s: velocities are multiplied by max(0, 1 - dt drag) each substep

  // The largest stable substep [s], infinite when nothing can vibrate.
  double largest_substep() const;
};

// By how much ω² grows at most where constraints are `stretch` times as long as at rest. Springs in all
// directions: never to more than twice that of the flat sheet. An edge of a membrane that is λ times as long
// is (3 λ² - 1)/2 times as stiff along itself, and (λ² - 1)/2 times sideways, where others are along.
inline double stiffening_of_springs(double stretch) {
  return stretch > 1 ? 1 + (1 - 1 / stretch) : 1;
}
inline double stiffening_of_membrane(double stretch) {
  return stretch > 1 ? 2 * stretch * stretch - 1 : 1;
}

}  // namespace weft::physics
