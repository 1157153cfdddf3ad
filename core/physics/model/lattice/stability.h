// How large a substep the methods allow.
//
// Explicit springs: leapfrog is stable while dt ω_max < 2, where ω_max² is the largest eigenvalue of M⁻¹K, K the
// tangent stiffness: Σ k [n nᵀ + max(0, 1 - l/|e|)(I - n nᵀ)] over the springs. Damping along the
// springs, evaluated at the velocity half a substep behind, asks for dt² ω²/4 + dt c/2 < 1 with c
// the largest eigenvalue of M⁻¹D; drag adds to c.
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

// s, of methods that project; about what a sheet of 1 m with 32 x 32 points needs.
inline constexpr double kLongestProjection = 1.0 / 960;

// Methods that project are stable at any substep, but a sweep of Gauss-Seidel or Jacobi passes a pull on
// over one constraint alone: each is as stiff as a substep can make it, m/(2 dt²), and a sheet of n
// points, h apart, that hangs by its edge stretches there by 2 n g dt²/h. A gas of pressure p in a mesh of
// density ρ stretches it as such a pull of g = p/ρ does. The longest substep that keeps this to 2 %, or lets one
// sweep do all that the material's own stiffness asks for, k dt² = m; at most kLongestProjection.
double projection_substep(const Scene& scene);

}  // namespace weft::physics
