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
  ConstRow3 x;  // sorted, 16 lanes of padding
  // Of every sorted particle: its place on the flat sheet, in spacings of its columns, those of
  // different sheets far apart, and the square of the distance there below which two are no pair.
  const float *u, *w, *apart_squared;
  const std::int32_t* bucket;
  const std::int32_t* start;  // of every bucket, one more than `table`
  std::int64_t table;         // buckets
  std::int64_t offset[9];     // from a bucket to the first of each run, modulo the table
  float range_squared;        // m²
  int begin, end;             // sorted particles to search about
  bool once;                  // pairs are listed by the first of the two alone, else by both
  std::int32_t* counts;       // out, per particle: how many are in range and no neighbours
  std::int32_t* neighbour;    // out, particle after particle: their numbers in sorted order
  std::int32_t* owner;        // out, for each of them, the number of the particle
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

// Pairs, one owner's after another's, and where those of them go that are nearer than a distance.
struct PairsWithin {
  const Body* bodies;  // of all particles with pairs; the others may hold anything
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of particles
  float reach;                            // in distances at which they are held
  // out, and 16 lanes of padding
  std::int32_t *within_owner, *within_neighbour;
};

// What a pair that touches asks of its owner, times its weight.
struct alignas(32) Asked {
  float push[4];  // displacement [m], and the weight alone
  float gain[4];  // velocity [m/s]
};

// Room for the pairs of one call that touch, and 16 lanes of padding.
struct SeparateRoom {
  std::int32_t *owner, *neighbour;
  Asked* asked;
};

// Particles from `begin` to `end`, and the pairs that they own.
struct SeparateOwners {
  const Body* bodies;
  int begin, end;
  int pairs;
  const std::int32_t *owner, *neighbour;
  const float* friction;  // of every particle with pairs, or kCourseRule
  float course_share;     // of a correction, per run
  float inverse_dt;       // 1/s
  Body* out;              // of all particles
  SeparateRoom room;
};

}  // namespace weft::physics
