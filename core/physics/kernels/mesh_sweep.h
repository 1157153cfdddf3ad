// What the sweeps over a mesh's constraints work on. While they run, vertices lie in records of eight floats:
// position, 0, correction so far, inverse mass. Where a vertex is, is the sum of position and correction:
// velocities gain exactly what the sweeps have moved it by.
#pragma once

#include "physics/kernels/mesh.h"

namespace weft::physics {

inline constexpr int kRecord = 8;  // floats
inline constexpr int kStrains = 3;

// One row of vertices and its records.
struct RecordRow {
  int columns;
  Row3 x, v;
  const float* w;     // 1/kg
  float* records;     // lane 0
  float inverse_dt;   // 1/s; velocities gain corrections times this
  Row3 left, v_left;  // what positions and velocities lack by rounding [m, m/s]; null: left aside
};

// 16 edges, no two of which share a vertex; ends are told by where their records begin. Those of no edge join
// a record of no vertex to itself.
struct alignas(64) EdgeBatch {
  std::int32_t near[kBatch], far[kBatch];
  float rest[kBatch];  // m
  float give[kBatch];  // m/N; one over the stiffness
};

struct EdgeSweep {
  const EdgeBatch* batches;
  int count;
  float* records;
  float inverse_dt2;  // 1/s²; times `give` it is the compliance
  float* lambda;      // multipliers of the batches; null: a single sweep [kg·m]
  bool fresh;         // the multipliers are still zero, whatever the memory says
  float longest;      // > 0: nothing but what is so many times its length is shortened to that
  // Of the batches' edges: squared lengths in the mean of before and after their own correction [m²]; null: nobody
  // asks.
  float* midst;
};

// 16 triangles, no two of which share a vertex; corners are told by where their records begin. Those of no
// triangle are of no vertex.
struct alignas(64) StrainBatch {
  std::int32_t corner[3][kBatch];
  float du[2][kBatch], dv[2][kBatch];  // 1/m; as of MeshBatch
  float area[kBatch];                  // m²
};

// Green's strains of triangles, told along warp, along weft, and as the sine between them.
struct StrainSweep {
  const StrainBatch* batches;
  int count;
  float* records;
  const float*
      before;  // records of where vertices were before the substep; null: no damping in this sweep
  bool damps;  // a sweep of damping alone, with `before`
  float give[4];  // m/N; the inverse of C: 11 22 12 66
  float dt2;      // s²
  float rate;     // damping over dt
  float* stress;  // multipliers of the batches, each three times 16 [N/m]; null: a single sweep
  bool fresh;     // they are still zero, whatever the memory says
  // Of the batches' sides, from corner k to the next, three times 16: squared lengths in the mean of before and
  // after their triangle's own correction [m²]; null: nobody asks.
  float* midst;
};

// Triangles in batches; corners are told by where their records begin, and moments are those of their constraints:
// P in Δλ = -P J (model/mesh/triangle_constraint.h).
struct HingeSweep {
  const MeshBatch* batches;
  int count;
  float* records;
  bool bows;  // whether bending is towards a shape that is not flat
};

}  // namespace weft::physics
