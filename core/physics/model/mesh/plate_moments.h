// What the jumps of slope at the sides of triangles cost, so that a mesh bends as a plate does whatever its
// triangles are.
//
// Each triangle's energy is ½ area (B h)ᵀ C (B h), with its jumps h, the curvature B h that is the mean of slopes
// at its sides, and C, which is 1 in the metric of the rigidities where each two triangles are one shape turned
// by half a turn, as on grids with diagonals alike. Elsewhere B h of a sheet of constant curvature K is not K but
// R K, and C = 1 is too stiff: twice as stiff against twisting with crossed diagonals, 1.5 times with random
// ones. So C is near to 1 such that, as well as it can be,
// - constant curvature is in balance: Σ Fᵀ (C R - W) K = 0 at every vertex, F being what a unit of moment in a
//   triangle pulls there with (those of C R = 1 are in balance, for the slope at a side is one for both triangles);
// - it has its energy: Σ area (Rᵀ C R - W) = 0 over the triangles about every vertex.
// W is 1, but for what a border lets go: no moment turns about a free edge. These are the two halves of the patch
// test, sought as virtual elements seek them (Brezzi, Marini 2013, "Virtual element methods for plate bending
// problems"), here by least squares over the sheet. A few steps of conjugate gradients do, since what is amiss is so
// from triangle to triangle; more would follow the few triangles for which there is no good C.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "weft/scene.h"

namespace weft::physics {

// A corner seen from a side: how far off it [m], and where along it, from 0 to 1 where it is between the ends.
struct Foot {
  double height = 0, at = 0;
};

// Two triangles at a side, laid flat.
struct Hinge {
  Foot own, away;
  double length = 0;      // m, of the side
  double n1 = 0, n2 = 0;  // its normal, out of the triangle, along warp and weft
  int across = -1;        // the triangle there; -1: none, and neither `own` nor `away` is known
  int side = 0;           // which of that triangle's sides this is
};

struct Plate {
  std::array<int, 6> corner;  // as of RestTriangle
  double area;                // m²
  Hinge hinge[3];
};

// The quadratic form of each triangle's jumps, 00 11 22 01 12 20 [N·m³]; it is never negative.
std::vector<std::array<double, 6>> plate_moments(const std::vector<Plate>& plates,
                                                 std::size_t vertices, const Bending& bending);

}  // namespace weft::physics
