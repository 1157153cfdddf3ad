// Stable substeps (spectrum.h).
#include "physics/model/spectrum.h"

#include <cmath>
#include <limits>

namespace weft::physics {

double Spectrum::largest_substep() const {
  // Root of dt² ω² + 2 dt c = most.
  const auto root = [&](double c, double most) {
    const double inverse = (c + std::sqrt(c * c + most * (omega_squared + load))) / most;
    return inverse > 0 ? 1 / inverse : std::numeric_limits<double>::infinity();
  };
  // What drag leaves of a velocity is 1 - dt drag, or nothing: dt² ω² + 2 dt c < 2 (1 + what is left).
  const double dt = root(damping + drag, 4);
  return dt * drag <= 1 ? dt : root(damping, 2);
}

}  // namespace weft::physics
