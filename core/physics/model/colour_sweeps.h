// Gauss–Seidel sweeps by colours: how many a substep takes, and which way they go.
//
// One way, sweeps leave of errors p e with complex p, and motion (of the first order z² = p (2 z - 1), as in
// lattice/sweeps.cpp) grows where the method takes less. There and back they are symmetric, p is real and not negative
// (Young 1971, "Iterative Solution of Large Linear Systems"), and nothing grows; but they leave up to several times as
// much. So they go back where what is stiff is solved in so short substeps that motion would grow.
#pragma once

#include <string>
#include <vector>

#include "weft/scene.h"

namespace weft::physics {

struct ColourSweeps {
  int count;
  bool back;  // every second one, through the colours from the last to the first
  bool backwards(int n) const { return back && n % 2 == 1; }
  bool operator==(const ColourSweeps&) const = default;
};

// In substeps of dt [s]. `rate`: the greatest stiffness of a constraint times the greatest inverse mass [1/s²]; infinite:
// rigid ones.
ColourSweeps colour_sweeps(const Solver& solver, double dt, double rate);
// Adds a note where more run than the scene asks for.
void note_sweeps(const ColourSweeps& sweeps, const Solver& solver, std::vector<std::string>& notes);

}  // namespace weft::physics
