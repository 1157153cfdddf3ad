// How large a substep explicit springs allow. Leapfrog is stable while dt ω_max < 2, where ω_max² is the
// largest eigenvalue of M⁻¹K, K the tangent stiffness: Σ k [n nᵀ + max(0, 1 - l/|e|)(I - n nᵀ)] over the
// springs. Damping along the springs, evaluated at the velocity half a substep behind, asks for
// dt² ω²/4 + dt c/2 < 1 with c the largest eigenvalue of M⁻¹D; drag adds to c.
#pragma once

#include <vector>

#include "physics/model/lattice/lattice.h"
#include "physics/model/lattice/membrane.h"
#include "physics/model/lattice/stencil.h"
#include "physics/model/spectrum.h"

namespace weft::physics {

// Estimates the spectrum of the lattice as it lies now by a Lanczos iteration, from above: the
// substep it allows is never larger than the true limit, and at most about 3 % smaller.
Spectrum estimate_spectrum(const Cloth& cloth, const std::vector<Stencil>& stencils,
                           const Lattice& lattice, bool damped, const KernelTable& kernels);

// The same of a membrane without stress, with its bending.
Spectrum membrane_spectrum(const Cloth& cloth, const MembraneCells& cells, const Lattice& lattice);

// kg; of the lightest particle where masses are given one by one, else of an inner one: what lies on the
// border may weigh less, and is held by as much less.
double lightest_mass(const Cloth& cloth);

}  // namespace weft::physics
