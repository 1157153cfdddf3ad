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
  std::int32_t *number, *farther;
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
  float near_squared;         // m²: those nearer than this come first
  int begin, end;             // sorted particles to search about
  std::int32_t* counts;       // out, per particle: how many are in range and no neighbours
  std::int32_t* hits;         // out, particle after particle: their numbers in sorted order
  int hits_room;
  NearRoom room;
};

// Where a search ended, how many it found, and the room that it needs to go on: 0 at `end`.
struct NearFound {
  int next, hits, needed;
};

// Thicknesses that a pair is held apart: layers of a stack sink in a little.
inline constexpr float kHeld = 1.05f;

// A particle with pairs.
struct alignas(32) Body {
  float x[4];  // place and thickness [m]
  float v[4];  // velocity [m/s] and inverse mass [1/kg]
};

// 16 owners next to each other and what each may touch: slot k of all of them, then slot k + 1. An
// owner with fewer neighbours names a body far away.
struct SeparateGroup {
  const Body* bodies;
  int first;  // number of the first owner
  int slots;
  const std::int32_t* neighbour;  // slots x 16
  const float* friction;          // of the 16 owners
  const std::int32_t* course;     // -1 in the lanes of owners with the course's rule
  float course_share;             // of a correction, per run
  float inverse_dt;               // 1/s
  Body* out;                      // of the first owner
};

}  // namespace weft::physics
