// Green's strains e = ((u·u - 1)/2, (v·v - 1)/2, u·v) of a piece of cloth, u and v the derivatives of position along
// warp and weft, and their stresses, as one constraint of three rows: triangles of meshes (mesh_strains.cpp), cells of
// grids (membrane_cells_sweep.cpp).
#pragma once

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

// Along warp, along weft, and of the angle between them.
struct Three {
  Wide of[3];
};

// A symmetric matrix of two rows.
struct Two {
  Wide uu, vv, uv;
};

// Strains of the metric u·u, v·v, u·v.
WEFT_INLINE Three strains(const Two& m) {
  return {{0.5f * (m.uu - 1.0f), 0.5f * (m.vv - 1.0f), m.uv}};
}

// The metric with its principal values raised to 1: 1 + (B + |B|)/2 with B the metric - 1, where
// |B| = (B² + |det B|)/tr |B| and B² = B tr B - det B.
WEFT_INLINE Two raised(const Two& metric) {
  constexpr float kTiny = 1e-30f;
  const Wide a = metric.uu - 1.0f, b = metric.vv - 1.0f;
  const Wide trace = a + b, mixed = 2.0f * max(metric.uv * metric.uv - a * b, Wide{});
  const Wide reciprocal = 1.0f / sqrt(trace * trace + 2.0f * mixed + kTiny);
  const Wide share = 0.5f + 0.5f * trace * reciprocal, more = 1.0f + 0.5f * mixed * reciprocal;
  return {more + share * a, more + share * b, share * metric.uv};
}

// x in M x = r by LDLᵀ; M positive, told by its diagonal and 01, 02, 12.
WEFT_INLINE Three solved(const Wide (&diagonal)[3], Wide m01, Wide m02, Wide m12, const Three& r) {
  // What a pivot is at least, of its diagonal: corners that are held leave some strains to be told by others.
  constexpr float kLeastPivot = 1e-5f;
  const Wide i0 = 1.0f / diagonal[0], l1 = m01 * i0, l2 = m02 * i0;
  const Wide i1 = 1.0f / max(diagonal[1] - l1 * m01, kLeastPivot * diagonal[1]);
  const Wide rest = m12 - l2 * m01, l3 = rest * i1;
  const Wide i2 = 1.0f / max(diagonal[2] - l2 * m02 - l3 * rest, kLeastPivot * diagonal[2]);
  const Wide y1 = r.of[1] - l1 * r.of[0], y2 = r.of[2] - l2 * r.of[0] - l3 * y1;
  const Wide x2 = y2 * i2, x1 = y1 * i1 - l3 * x2;
  return {{r.of[0] * i0 - l1 * x1 - l2 * x2, x1, x2}};
}

// Δs in (A + C⁻¹) Δs = r, A made of the metric and of g: Σ w du du, Σ w dv dv, Σ w du dv of the corners, where
// ∂e/∂x = (u du, v dv, u dv + v du). `give`: C⁻¹, 11 22 12 66. A piece that is pressed together has small
// derivatives, and a step by these would go far beyond where they hold, so A has the metric raised to 1 at least: its
// step is short rather than long, what it comes to is the same.
WEFT_INLINE Three stress_step(const Two& metric, const Two& g, const float (&give)[4],
                              const Three& r) {
  const Two m = raised(metric);
  const Wide sheared = m.uu * g.vv + m.vv * g.uu + 2.0f * m.uv * g.uv;
  const Wide diagonal[3] = {m.uu * g.uu + give[0], m.vv * g.vv + give[1], sheared + give[3]};
  return solved(diagonal, m.uv * g.uv + give[2], m.uu * g.uv + m.uv * g.uu,
                m.uv * g.vv + m.vv * g.uv, r);
}

// Adds C⁻¹ s to what is left of the strains.
WEFT_INLINE void add_give(const float (&give)[4], const Three& stress, Three& r) {
  r.of[0] = r.of[0] + give[0] * stress.of[0] + give[2] * stress.of[1];
  r.of[1] = r.of[1] + give[2] * stress.of[0] + give[1] * stress.of[1];
  r.of[2] = r.of[2] + give[3] * stress.of[2];
}

}  // namespace weft::WEFT_KERNELS
