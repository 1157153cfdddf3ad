// Line sweeps of the membrane: as those of springs (line.cpp), with half of the squared length in the place
// of the length, so that what a line's constraints hold is the energy of Green's strains:
//
//   C_c = (e_c·e_c - s_c)/2,   energy ½ C_c²/(α̃ dt²)
//   (w_c + w_{c+1}) |e_c|² μ_c + α̃ μ_c - w_c e_{c-1}·e_c μ_{c-1} - w_{c+1} e_c·e_{c+1} μ_{c+1}
//       = C_c + α̃ λ_c = r_c
//   u_c <- u_c + w_c (μ_c e_c - μ_{c-1} e_{c-1}),  λ_c <- λ_c - μ_c
//
// No root, and no division but the pivot's. s_c is the square of the rest length, or what the other strains of
// the cells beside it make of that (membrane_squares.cpp). Newton's second step starts from where the first
// has led, along edges as they lie there.
#include "physics/kernels/line_block.h"

namespace weft::WEFT_KERNELS {

void membrane_line_batch(const LineBatch& p) {
  solve_lines<LineLaw::square>(p);
}

}  // namespace weft::WEFT_KERNELS
