// The bending of a triangle as a compliant constraint. Its energy is ½ Σ M_kl J_k·J_l over its hinges, with
// jumps J_k = Σ a_ki x_i: linear, so that one step of the compliant method (Macklin, Müller, Chentanez 2016)
// over h is Δλ = -P J with P = (A + (h² M)⁻¹)⁻¹ = h² M (1 + A h² M)⁻¹, A_kl = Σ w_i a_ki a_li, for whatever M.
// Curved at rest, J is less p × q `bow`, which corners move as well: A has the greatest that this comes to, so that
// the step is short rather than long.
#pragma once

#include <functional>

#include "physics/model/mesh/rest_triangles.h"

namespace weft::physics {

// P, in the order of RestTriangle::moment. `inverse_mass`: of a vertex [1/kg].
std::array<double, 6> hinge_matrix(const RestTriangle& triangle, double h,
                                   const std::function<double(int)>& inverse_mass);

}  // namespace weft::physics
