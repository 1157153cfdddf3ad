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

// A box, and others: arrays with 16 lanes of padding.
struct NearBoxes {
  const float *low[3], *high[3];  // m
  int begin, end;                 // those looked at
  Spread box;
  float distance_squared;  // m²
  // Out, and 16 lanes of padding: the numbers of those that are nearer than that, and their distances
  // squared, 0 where boxes overlap.
  std::int32_t* near;
  float* square;
};

// Cells along an axis, at most. (Their numbers stay within 64 bits.)
inline constexpr float kMostCells = 1e6f;

// The buckets of particles (cell_grid.h): a + b stride_y + c stride_z for cell (a, b, c), counted from 1
// at `low`, modulo the table's size where it wraps.
struct CellKeys {
  ConstRow3 x;
  int begin, end;  // whole groups of 16 lanes, beyond the end too
  float low[3];    // m
  float last[3];   // the last cell along each axis, counted from 0; what lies beyond is in it
  float inverse;   // of the cells' size [1/m]
  std::int64_t stride_y, stride_z, table;
  bool wraps;
  std::int32_t* key;  // out
};

// Room to bring the candidates of a cell together: arrays of `size`, candidates and the padding.
inline constexpr int kNearPadding = 32;
struct NearRoom {
  Row3 x;
  std::int32_t* name;
  int size;
};

// A sheet whose particles are named from `first` on. Two of them are neighbours, and no pair, when their
// names differ by no less than one of the windows' low and no more than its high.
struct NameWindow {
  std::int32_t low, high;
};
struct NearSheet {
  std::int32_t first;
  const NameWindow* window;
  int windows;
};

// Particles in order of their buckets (cell_grid.h), and the nine runs of three buckets about each.
struct NearSearch {
  // Sorted, 16 lanes of padding before them and after; their names, by which they are listed, likewise.
  // Null: they are listed by their numbers in sorted order, and there are no neighbours.
  ConstRow3 x;
  const std::int32_t* name;
  const NearSheet* sheet;  // in order of their first names
  int sheets;
  const std::int32_t* bucket;
  const std::int32_t* start;  // of every bucket, one more than `table`
  std::int64_t table;         // buckets
  std::int64_t offset[9];     // from a bucket to the first of each run, modulo the table
  float range_squared;        // m²
  int begin, end;             // sorted particles to search about
  // Out, particle after particle: those after it in sorted order that are in range and no neighbours,
  // and for each of them the particle.
  std::int32_t *neighbour, *owner;
  int pairs_room;  // of both
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

// Where a particle is, and the distance at which it is held from its like [m].
struct alignas(16) Place {
  float x[4];
};

// Its velocity [m/s] and inverse mass [1/kg]: apart from its place, which is looked at far more often.
struct alignas(16) Motion {
  float v[4];
};

// A block of particles in the lattice, and as bodies: places and motions.
struct BodyBlock {
  int columns, rows;
  std::ptrdiff_t stride, body_stride;  // from row to row of the lattice, and of the bodies
  Row3 x, v;       // the first particle; in whole groups of lanes, beyond the columns too
  const float* w;  // inverse mass [1/kg]
  float held;      // the distance at which they are held from their like [m]
  Place* place;
  Motion* motion;
  // For scattering, laid out as x: by how much contact has to change their velocities, their load
  // [m/s²]; and what it has given of that in advance the last time, and then gives now [m/s].
  Row3 load, ahead;
  float since, inverse_since;  // the last time: s, 1/s
  float advance;               // share of a lasting load that is given in advance
  // What neither contact has moved nor carries a load is passed over, 16 columns at once: whether any of
  // every 16 bodies has moved, and the first of these; and of every 16 in the lattice, whether any has a
  // load or something in advance, the first of the block's.
  const std::uint8_t* moved;
  std::int32_t first_body;
  std::uint8_t* loaded;
};

// Room for pairs, and 16 lanes of padding.
struct PairRoom {
  std::int32_t *owner, *neighbour;
  PairRoom from(int i) const { return {owner + i, neighbour + i}; }  // pair i on
};

// So many columns and rows further on in a sheet: down > 0, or down = 0 and across > 0. Several are in
// order of `down`.
struct SheetStep {
  int across, down;
};

// Particles of one sheet, and those that lie a step away in it, row against row: no list is needed to
// find them.
struct BesidePairs {
  ConstRow3 x;  // the sheet's first particle
  std::ptrdiff_t stride;
  int columns, rows;              // of the sheet
  int column, row;                // the block's first particle,
  int block_columns, block_rows;  // and how many it has
  const SheetStep* step;
  int steps;
  float range_squared;              // m²
  std::int32_t first, name_stride;  // names, of the sheet's first particle and from row to row
  // Out, row after row, 16 columns after 16 and step after step: pairs within the range. Room for
  // block_columns * steps more than `most`.
  PairRoom pairs;
  int most;
};

// Of a block, or as many of its rows as there was room for.
struct BesideFound {
  int rows, pairs;
};

// Pairs, one owner's after another's, and where those of them go that are close, nearer than `reach` of
// the distances at which they are held, and those that touch, nearer than these.
struct ClosePairs {
  const Place* place;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of particles
  float reach;
  PairRoom close, touching;  // out
};

struct CloseFound {
  int close, touching;
};

// Coulomb's coefficient of every body, or kCourseRule; null: all alike.
struct BodyFriction {
  const float* each;
  float alike;
};

// What a pair that touches asks for, times its weight: of its owner a share, and of its neighbour the
// rest, the other way.
struct alignas(32) Asked {
  float push[4];  // displacement [m], and the weight
  float gain[4];  // velocity [m/s], and the owner's share
};

// Pairs that touch, and what they ask for.
struct AskPairs {
  const Place* place;
  const Motion* motion;
  BodyFriction friction;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of particles
  Asked* asked;                           // out, and 16 more
};

struct AskFound {
  float fastest_squared;  // relative speed of two, at most [m²/s²]
  float deepest;          // of the distance at which they are held
};

// What all its pairs ask of a body.
struct alignas(32) AskedSum {
  float push[4];  // m, and the weight
  float gain[4];  // m/s
};

// Pairs, what they ask for, and where it is summed up for the bodies from `begin` to `end`. Returned is
// how many of these get something for the first time: they are listed in `body`, which has room for one
// more than there can be.
struct SumAsked {
  int pairs;
  const std::int32_t *owner, *neighbour;
  const Asked* asked;
  std::int32_t begin, end;
  AskedSum* sum;
  std::int32_t* body;
};

// Bodies, and what they are asked, which is nothing any more afterwards.
struct MoveBodies {
  Place* place;
  Motion* motion;
  BodyFriction friction;
  AskedSum* sum;
  int bodies;
  const std::int32_t* body;
  std::uint8_t* moved;  // out: set for every 16 bodies of which one moves
  float course_share;   // of a correction, per run
  float inverse_dt;     // 1/s
};

}  // namespace weft::physics
