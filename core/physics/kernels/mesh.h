// Triangles of a mesh as kernels see them. A substep goes through the rows of vertices; those that triangles
// of a row reach lie in records of four floats, a few rows in turn, in place of component arrays: a corner
// is one load then.
#pragma once

#include "physics/kernels/kernel_list.h"
#include "physics/kernels/particles.h"
#include "physics/kernels/wind.h"

namespace weft::physics {

inline constexpr int kBatch = 16;  // triangles, no two of which share a vertex
inline constexpr int kMeshCorners =
    6;  // of a triangle, and those of its neighbours across each side

// One row of vertices, and where its records are: position, velocity and force.
struct MeshRow {
  int columns;
  Row3 x, v;
  const float* w;
  float *position, *velocity, *force;  // 4 floats a vertex; velocity may be null
  Advance advance;
  Left left{};
};

// Of 16 triangles. Records are told by their number; those of no triangle, and of no neighbour, are the
// last, which nobody reads.
struct alignas(64) MeshBatch {
  std::int32_t corner[kMeshCorners][kBatch];
  // x = corner 1 - corner 0, y = corner 2 - corner 0: d/du = x du[0] + y du[1], d/dv likewise [1/m].
  float du[2][kBatch], dv[2][kBatch];
  float area[kBatch];     // m²; 0: no triangle
  float rest[3][kBatch];  // m; of the sides from corner k to the next
  float half[3][kBatch];  // 1, or 0 for no triangle and for a side that has torn
  // Hinge k: corner 3 + k off the triangle, as weights of all: away[k] (corner 3+k - foot) + own[k]
  // (corner k+2 - foot), each foot at a share of the side from corner k on.
  float away[3][kBatch], away_at[3][kBatch], own[3][kBatch], own_at[3][kBatch];
  float bow[3][kBatch];     // 1/m²; of a hinge at rest, along x × y
  float moment[6][kBatch];  // of the hinges: 00 11 22 01 12 20 [N·m³]
};

struct MeshForces {
  const MeshBatch* batches;
  int count;
  const float *position, *velocity;  // records; velocity null: nothing is damped
  float* force;
  bool membrane;                      // else springs along the sides
  float c11, c22, c12, c66, damping;  // N/m, s
  float stiffness, spring_damping;    // N/m, N·s/m; half of an inner edge's
  bool bends;
  bool bows;           // whether bending is towards a shape that is not flat
  float bend_damping;  // s
};

// Of 16 triangles in the wind; those past `count` are none. The values of a corner lie in the component
// arrays at `corner`, and the sums of what air does to it at `sum`.
struct MeshAirBatch {
  std::int32_t corner[3][kBatch], sum[3][kBatch];
  int count;
};

struct MeshWind : Air {
  const MeshAirBatch* batches;
  int count;
  ConstRow3 x, v;  // of all vertices
  AirRow sums;
};

struct RecordRow;  // kernels/mesh_sweep.h
struct EdgeSweep;
struct HingeSweep;
struct StrainSweep;
struct TearEdges;  // kernels/tear.h

// mesh_load: positions and velocities into records, forces <- 0; mesh_forces: of triangles, added to the records
// of their corners; mesh_move: leapfrog step from the forces of the records; mesh_wind: of triangles, added to the
// sums of their corners. load_records: positions and inverse masses, corrections <- 0; store_records: positions,
// and velocities, gain the corrections. tear_edges: returns whether any is too long.
#define WEFT_MESH_KERNELS(KERNEL)                   \
  KERNEL(void, mesh_load, (const MeshRow&))         \
  KERNEL(void, mesh_forces, (const MeshForces&))    \
  KERNEL(void, mesh_move, (const MeshRow&))         \
  KERNEL(void, mesh_wind, (const MeshWind&))        \
  KERNEL(void, load_records, (const RecordRow&))    \
  KERNEL(void, store_records, (const RecordRow&))   \
  KERNEL(void, sweep_edges, (const EdgeSweep&))     \
  KERNEL(void, sweep_hinges, (const HingeSweep&))   \
  KERNEL(void, sweep_strains, (const StrainSweep&)) \
  KERNEL(bool, tear_edges, (const TearEdges&))

struct MeshKernels {
  WEFT_MESH_KERNELS(WEFT_KERNEL_MEMBER)
};

}  // namespace weft::physics
