// Line sweeps: all constraints of a line (a row, column or diagonal of the sheet) solved as one
// tridiagonal system in their multipliers, with lanes across the lines.
//
// For constraints c = 0, 1, … along a line of particles at x + u, e_c from particle c to particle c+1, and
// the multiplier of c written as μ_c |e_c| (which frees the equations of every division but the pivot's):
//
//   (w_c + w_{c+1} + α̃) |e_c|² μ_c - w_c e_{c-1}·e_c μ_{c-1} - w_{c+1} e_c·e_{c+1} μ_{c+1}
//       = |e_c|² - |e_c| (l - α̃ λ_c) = r_c,      α̃ = 1/(k dt²)
//   u_c <- u_c + w_c (μ_c e_c - μ_{c-1} e_{c-1}),  λ_c <- λ_c - μ_c |e_c|
//
// the Newton step of the compliant constraints of one line together (Macklin, Müller, Chentanez
// 2016, with the whole of a line in place of one constraint), by the Thomas algorithm: elimination
// walks the lines forwards and substitution backwards, where
//
//   f_c = w_c e_{c-1}·e_c / p_{c-1},   p_c = (w_c + w_{c+1} + α̃) |e_c|² - f_c w_c e_{c-1}·e_c,
//   r_c <- r_c + f_c r_{c-1},          μ_c = r_c / p_c + f_{c+1} μ_{c+1}.
//
// A constraint that does not exist or is cut has an edge and a pivot's reciprocal of zero: its
// multiplier is zero and the line falls into two. So a diagonal that leaves the sheet at one side
// goes on at the other, where the next begins, and all lines are equally long.
#include "physics/kernels/line_block.h"

namespace weft::WEFT_KERNELS {

void line_batch(const LineBatch& p) {
  solve_lines<LineLaw::length>(p);
}

}  // namespace weft::WEFT_KERNELS
