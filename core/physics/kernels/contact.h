// What the kernels of self-collision take: bounds of blocks (block_bounds.cpp), the search for pairs
// (near_pairs.cpp), and contacts (contact_packets.cpp).
#pragma once

#include <cstdint>

#include "physics/kernels/kernel_list.h"
#include "physics/kernels/rows.h"

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

// The buckets of particles (spatial_hash.h): a + b stride_y + c stride_z for cell (a, b, c), counted from 1
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

// Particles in order of their buckets (spatial_hash.h), and the nine runs of three buckets about each.
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

// Where a body, a particle of a sheet, is at the start of an interval of contact [m], and half the
// distance at which it is held from others [m].
struct alignas(16) Place {
  float x[4];
};

// By how much it is moved in the interval [m], and its inverse mass [1/kg].
struct alignas(16) Displacement {
  float u[4];
};

// A block of particles in the lattice, and as bodies.
struct BodyBlock {
  int columns, rows;
  std::ptrdiff_t stride, body_stride;  // from row to row of the lattice, and of the bodies
  ConstRow3 x;                         // the first particle
  const float* w;                      // inverse mass [1/kg]
  float half_held;                     // half the distance at which they are held [m]
  const Place* before;                 // at the start of the interval
  Place* now;                          // out, in whole groups of lanes: where they are now,
  Displacement* moved;                 // and how far they have come
};

// Rows of bodies, where they were once with their allowances, and how they move in an interval; what is common to all
// is taken off, before the interval and in it.
struct StrayedBodies {
  int columns, rows;
  std::ptrdiff_t stride;  // from row to row
  const Place *from, *place;
  const Displacement* moved;
  float before[3], common[3];  // m
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

// Pairs of bodies, and where those of them go that touch: that end the interval nearer than `reach` times
// the distance at which they are held, or would without what bends their way.
struct MeetingPairs {
  const Place* place;
  const Displacement* moved;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of bodies
  float reach;
  PairRoom meeting;  // out
};

// Contacts of N bodies, 16 that share no body, in component arrays. The relative displacement of two
// surfaces is Σ share u over the bodies (two: u_0 - u_1), `normal` points to where shares are positive.
inline constexpr int kPacket = 16;
template <int N>
struct alignas(64) ContactPacket {
  std::int32_t body[N][kPacket];
  float share[N][kPacket];
  float normal[3][kPacket];
  float distance[kPacket], held[kPacket];  // at the start, and at which it is held [m]
  float friction[kPacket];
  float slide[3][kPacket];  // relative displacement along the surface without contact [m],
  float gap[kPacket];       // and how much nearer the two may come than that brings them [m]
  float per[kPacket];       // 1/Σ share² w [kg]; 0 where nothing moves
  // Impulses times the interval, so far: normal, and along the surface [kg m].
  float pressed[kPacket], rubbed[3][kPacket];
};

template <int N>
struct ContactPackets {
  ContactPacket<N>* packet;
  int packets;
  const Place* place;
  const Displacement* moved;
  Displacement* change;  // of displacements by contact, and inverse masses again
  float share;           // of what is too close, that is put apart at once,
  float most;            // but no more than that [m]
};

// What is done with packets of contacts, one after another (contact_packets.cpp).
template <int N>
struct ContactKernels {
  void (*prepare)(const ContactPackets<N>&);
  float (*sweep)(const ContactPackets<N>&);     // returns the greatest correction [m]
  float (*separate)(const ContactPackets<N>&);  // returns the greatest depth [of the distance held]
};

struct SquaresWithin;  // kernels/surface.h
struct SquaresApart;
struct SquaresAwake;
struct SquaresAlike;
struct CornerWaysOfRow;
struct BesideAwake;
struct SquareGaps;
struct SurfacePairs;

// block_bounds: how a block lies and moves; block_edges: and its edges. near_boxes, meeting_pairs, squares_…,
// beside_awake: return how many are. near_pairs: who is in range of whom. any_strayed: returns whether any has left its
// allowance. surface_pairs: returns how many contacts there are.
#define WEFT_SHEET_KERNELS(KERNEL)                        \
  KERNEL(void, block_bounds, (const BlockRows&))          \
  KERNEL(void, block_edges, (const BlockRows&))           \
  KERNEL(int, near_boxes, (const NearBoxes&))             \
  KERNEL(void, cell_keys, (const CellKeys&))              \
  KERNEL(NearFound, near_pairs, (const NearSearch&))      \
  KERNEL(BesideFound, beside_pairs, (const BesidePairs&)) \
  KERNEL(void, gather_bodies, (const BodyBlock&))         \
  KERNEL(bool, any_strayed, (const StrayedBodies&))       \
  KERNEL(int, meeting_pairs, (const MeetingPairs&))       \
  KERNEL(int, squares_within, (const SquaresWithin&))     \
  KERNEL(int, squares_not_apart, (const SquaresApart&))   \
  KERNEL(int, squares_awake, (const SquaresAwake&))       \
  KERNEL(void, corner_ways, (const CornerWaysOfRow&))     \
  KERNEL(int, beside_awake, (const BesideAwake&))         \
  KERNEL(void, square_gaps, (const SquareGaps&))          \
  KERNEL(void, squares_alike, (const SquaresAlike&))      \
  KERNEL(int, surface_pairs, (const SurfacePairs&))

// Of contact between sheets.
struct SheetKernels {
  WEFT_SHEET_KERNELS(WEFT_KERNEL_MEMBER)
  ContactKernels<2> contacts_of_two;
  ContactKernels<4> contacts_of_four;
};

}  // namespace weft::physics
