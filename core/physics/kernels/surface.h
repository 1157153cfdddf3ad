// What the kernels of contact among surfaces take (surface.cpp).
#pragma once

#include "physics/kernels/contact.h"

namespace weft::physics {

// A square of a sheet: its corners A (its number's particle), B beyond A along the row, C below A, D
// below B, as bodies. It owns the vertex A, the edges AB, AC and BC, and the triangles ABC and BDC. At a
// sheet's end corners beyond it are those before them: what has no length or area there is of no
// account.
struct alignas(16) Square {
  std::int32_t corner[4];
};

// Where a body is on the sheet at rest [m], and which sheet that is.
struct alignas(16) RestPlace {
  float x, y, z, sheet;
};

// Box about a square, through an interval.
struct SquareBox {
  float low[3], unused;        // m
  float high[3], also_unused;  // m
};

// Pairs of squares, and where those of them go whose boxes are within a range.
struct SquaresWithin {
  const SquareBox* boxes;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of squares
  float range;                            // m
  // out, and 16 lanes of padding
  std::int32_t *within_owner, *within_neighbour;
};

// Times that, sums of two ways are not above what they are in truth.
inline constexpr float kRoundedDown = 1 - 16 * 6e-8f;

// Pairs of squares, and where those of them go that are awake, as ways tell (contact/self/near_squares.h), and whose
// boxes are within a range. What is awake and farther off falls asleep.
struct SquaresAwake {
  const SquareBox* boxes;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of squares
  float* until;                           // m, in ways, of every pair, and 16 lanes; in and out
  const float* way;                       // m, of every square
  float range;                            // m
  std::int32_t number;                    // of the first pair
  std::int32_t *near_owner, *near_neighbour, *near_number;  // out, and 16 lanes of padding
};

// Squares of a row, in whole groups of lanes: how far their corners come from each other in an interval.
struct CornerWaysOfRow {
  const Displacement* moved;
  const Square* squares;  // the first,
  int count;              // and how many
  float *all, *last;      // m, of the first: added to; out
};

// Pairs of the squares of a row with others that follow each other likewise, and where those of them go that are awake,
// as ways tell (contact/self/corner_ways.h).
struct BesideAwake {
  int pairs;
  const float *way, *other_way;    // m, of the first pair's squares
  const float* until;              // m, in ways, of the first pair
  std::int32_t owner, neighbour;   // of the first pair: squares,
  std::int32_t number, and_so_on;  // its own number, and from number to number
  std::int32_t *awake_owner, *awake_neighbour, *awake_number;  // out, and 16 lanes of padding
};

// Pairs of squares of one grid that share a corner, or are one square (squares_alike.cpp).
struct SquaresAlike {
  const Place* place;
  const Square* squares;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of squares
  float uu, uv, vv;                       // m², of the edges at rest
  // By how much corners may come from each other at least before the two lie so that they may touch, negative where
  // they may [m]. Out, and 16 lanes of padding.
  float* change;
};

// How far two squares are from each other at least, without what they have in common.
struct SquareGaps {
  const Place* place;
  const Square* squares;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of squares
  float* gap;                             // out, and 16 lanes of padding [m]
};

// Pairs of squares, and where those of them go that neither boxes about them nor a plane along one of the two keep more
// than a range apart all through an interval: the others come nowhere nearer.
struct SquaresApart {
  const Place* place;
  const Displacement* moved;
  const Square* squares;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of squares
  float range;                            // m
  // Out, and 16 lanes of padding; may be the same as above.
  std::int32_t *near_owner, *near_neighbour;
};

// A vertex and a triangle, or two edges, of a pair of squares: bodies and their shares, positive where
// the normal points to; how far apart they are at the start of the interval, and held [m].
struct SurfaceContact {
  std::int32_t pair, kind;  // which of the given pairs, which of the 13 of a pair
  std::int32_t body[4];
  float share[4];
  float normal[3], distance, held;
};
inline constexpr int kKindsOfPair = 13;

// What to look for: contacts, or whatever may pass through in the interval.
enum class SurfaceSearch { contacts, passing };

// Pairs of squares to be measured, each against each.
struct SurfacePairs {
  const Place* place;
  const Displacement* moved;
  const RestPlace* rest;
  const Square* squares;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of squares
  SurfaceSearch search;
  float reach;  // contacts: how near they end the interval, without what bends their way [of h]
  float floor;  // passing: how near nothing may come [of h], or a tenth of where it started
  SurfaceContact* found;  // out; room for kKindsOfPair of each pair
};

}  // namespace weft::physics
