// What limits the substeps of explicit methods.
#pragma once

namespace weft::physics {

// Leapfrog is stable while dt ω_max < 2; damping along the springs, evaluated at the velocity half a
// substep behind, asks for dt² ω²/4 + dt c/2 < 1.
struct Spectrum {
  double omega_squared = 0;  // 1/s², ω_max²: the largest eigenvalue of M⁻¹K
  double damping = 0;        // 1/s, c: the largest eigenvalue of M⁻¹D

  // The largest stable substep [s], infinite when nothing can vibrate.
  double largest_substep() const;
};

}  // namespace weft::physics
