// What the kernels of self-collision take: bounds of blocks (block_bounds.cpp), the search for pairs
// (near_pairs.cpp), and pushing pairs apart (separate.cpp).
#pragma once

#include <cstdint>

#include "physics/kernels/kernels.h"

namespace weft::physics {

// Least and greatest of some values, component by component.
struct Spread {
  float low[3], high[3];
};

// How the particles of a block lie, move and have moved, and how their edges do: those from each of
// them to the next along its row and along its column, into the blocks beyond included.
struct BlockBounds {
  Spread x, v;                        // m, m/s
  Spread moved;                       // since `then` [m]
  Spread along, across;               // edges along rows and along columns [m]
  float change_along, change_across;  // greatest squared change of an edge [m²/s²]
};

struct BlockRows {
  int columns, rows;  // particles of the block
  int edges_along;    // edges that start in each row of it: columns, or one less at the sheet's end
  int edges_across;   // rows from which edges start
  int stride;
  ConstRow3 x, v;       // the block's first particle
  ConstRow3 then;       // earlier positions, null: `moved` stays as it is
  BlockBounds* bounds;  // out
};

// Room to bring the candidates of a cell together: arrays of `size`, candidates and the padding.
inline constexpr int kNearPadding = 32;
struct NearRoom {
  Row3 x;
  float *u, *w;
  std::int32_t* number;
  int size;
};

// Particles in order of their buckets (cell_grid.h), and the nine runs of three buckets about each.
struct NearSearch {
  ConstRow3 x;  // sorted, 16 lanes of padding before them and after
  // Of every sorted particle, padded likewise: its place on the flat sheet, in spacings of its columns,
  // those of different sheets far apart, and the square of the distance there below which two are no
  // pair.
  const float *u, *w, *apart_squared;
  const std::int32_t* names;  // by which they are listed; null: by their number in sorted order
  const std::int32_t* bucket;
  const std::int32_t* start;  // of every bucket, one more than `table`
  std::int64_t table;         // buckets
  std::int64_t offset[9];     // from a bucket to the first of each run, modulo the table
  float range_squared;        // m²
  int begin, end;             // sorted particles to search about
  bool once;                  // pairs are listed by the first of the two alone, else by both
  std::int32_t* neighbour;    // out, particle after particle: those in range and no neighbours
  std::int32_t* owner;        // out, for each of them, the particle
  int pairs_room;             // of both
  NearRoom room;
};

// Where a search ended, how many pairs it found, and the room that it needs to go on: 0 at `end`.
struct NearFound {
  int next, pairs, needed;
};

// Thicknesses that a pair is held apart: layers of a stack sink in a little.
inline constexpr float kHeld = 1.05f;

// In place of an owner's friction: pushed by the course's rule.
inline constexpr float kCourseRule = -1;

// A particle.
struct alignas(32) Body {
  float x[4];  // place, and the distance at which it is held from its like [m]
  float v[4];  // velocity [m/s] and inverse mass [1/kg]
};

// A block of particles in the lattice, and as bodies, laid out alike.
struct BodyBlock {
  int columns, rows;
  std::ptrdiff_t stride;
  Row3 x, v;       // the first particle; in whole groups of lanes, beyond the columns too
  const float* w;  // inverse mass [1/kg]
  float held;      // the distance at which they are held from their like [m]
  Body* bodies;
  // For scattering, laid out as x: by how much contact has to change their velocities, their load
  // [m/s²]; and what it has given of that in advance the last time, and then gives now [m/s].
  Row3 load, ahead;
  float since, inverse_since;  // the last time: s, 1/s
  float advance;               // share of a lasting load that is given in advance
};

// Room for pairs, and 16 lanes of padding.
struct PairRoom {
  std::int32_t *owner, *neighbour;
};

// Pairs, one owner's after another's, and where those of them go that are close, nearer than `reach` of
// the distances at which they are held, and those that touch, nearer than these.
struct ClosePairs {
  const Body* bodies;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of particles
  float reach;
  PairRoom close, touching;  // out
};

struct CloseFound {
  int close, touching;
};

// What a pair that touches asks of its owner, times its weight.
struct alignas(32) Asked {
  float push[4];  // displacement [m], and the weight alone
  float gain[4];  // velocity [m/s]
};

// Pairs that touch, one owner's after another's, and where their owners go.
struct SeparateOwners {
  const Body* bodies;
  int pairs;
  PairRoom touching;      // overwritten
  Asked* asked;           // room for what these ask for
  const float* friction;  // of every body, or kCourseRule; null: alike
  float friction_alike;
  float course_share;  // of a correction, per run
  float inverse_dt;    // 1/s
  // out, owners, and 16 lanes of padding
  std::int32_t* moved_owner;
  Body* moved;
};

struct Separated {
  int moved;      // owners
  float fastest;  // greatest squared relative speed of two that touch [m²/s²]
};

}  // namespace weft::physics
