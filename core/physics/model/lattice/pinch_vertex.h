// Hinges: particles that alone hold two pieces of a torn sheet together.
//
//   NW--N---NE      A particle p is joined to the eight around it, and these to each other by the
//    | \ | \ |      constraints about p. Where those fall into pieces that each share a whole triangle
//    W---p---E      with p, the sheet around p has separated: p goes with the piece that shares most of
//    | \ | \ |      its triangles, and what joins it to the others ends. A thread, joined to p but
//   SW--S---SE      without a triangle, goes on hanging from it.
//
// So a tear that turns at a particle is as open there as anywhere else: it runs past one side of it.
#pragma once

#include <array>

#include "physics/model/lattice/tearing.h"

namespace weft::physics {

// The eight directions around a particle, each next to the one before.
struct Direction {
  int di, dj;
};
inline constexpr std::array<Direction, 8> kAround{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

// The directions (bits, in the order of kAround) in which constraints of particle (i, j) are to end; 0
// where it is no pinch vertex.
unsigned pinched(const LatticeTearing& tearing, int i, int j);

}  // namespace weft::physics
