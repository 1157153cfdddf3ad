// What the sweeps over a mesh's constraints work on. While they run, vertices lie in records of eight floats:
// position, 0, correction so far, inverse mass. Where a vertex is, is the sum of position and correction:
// velocities gain exactly what the sweeps have moved it by.
#pragma once

#include "physics/kernels/mesh.h"

namespace weft::physics {

inline constexpr int kRecord = 8;  // floats

// One row of vertices and its records.
struct RecordRow {
  int columns;
  Row3 x, v;
  const float* w;    // 1/kg
  float* records;    // lane 0
  float inverse_dt;  // 1/s; velocities gain corrections times this, 0 = they are not touched
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
