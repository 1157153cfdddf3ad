// Gauss–Seidel over the membrane of a mesh, the triangles of a batch side by side. A triangle is one constraint of
// three rows, Green's strains e = ((u·u - 1)/2, (v·v - 1)/2, u·v), u and v the derivatives of position along warp
// and weft, with the energy ½ area e·C e. Its multipliers are stresses s:
//
//   r = e + rate (e - e_before) + C⁻¹ s,  Δs = ((1 + rate) A + C⁻¹)⁻¹ r,  s <- s - Δs
//   A = h² area Σ w_k ∂e/∂x_k ∂e/∂x_kᵀ
//   x_k <- x_k - h² area w_k (p du_k + q dv_k),  p = u Δs_1 + v Δs_3,  q = u Δs_3 + v Δs_2
//
// (Macklin, Müller, Chentanez 2016; the rate of strain is that of Green's strain over the substep, which turning
// leaves alone.) Where strands take turns with triangles, damping is in these equations. Colours alone have a sweep of
// it before theirs, r = rate (e - e_before) + C⁻¹ s, Δs = (rate A + C⁻¹)⁻¹ r (membrane_sweep.cpp says why). No root but
// one: A is made of the metric u·u, u·v, v·v. A triangle that is pressed together has small derivatives, and a step by
// these would go far beyond where they hold, so A has the metric with its principal values raised to 1 at least: its step
// is short rather than long, what it comes to is the same.
#include "physics/kernels/mesh_sweep.h"
#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

using physics::kBatch;
using physics::kRecord;
using physics::kStrains;
using physics::StrainBatch;
using physics::StrainSweep;

// What a pivot is at least, of its diagonal: corners that are held leave some strains to be told by others.
constexpr float kLeastPivot = 1e-5f;
constexpr float kTiny = 1e-30f;

struct Three {
  Wide of[kStrains];
};

// A symmetric matrix of two rows.
struct Two {
  Wide uu, vv, uv;
};

struct Derivatives {
  Wide3 u, v;
  WEFT_INLINE Two metric() const { return {dot(u, u), dot(v, v), dot(u, v)}; }
};

WEFT_INLINE Three strains(const Two& m) {
  return {{0.5f * (m.uu - 1.0f), 0.5f * (m.vv - 1.0f), m.uv}};
}

// The metric with its principal values raised to 1: 1 + (B + |B|)/2 with B the metric - 1, where
// |B| = (B² + |det B|)/tr |B| and B² = B tr B - det B.
WEFT_INLINE Two raised(const Two& metric) {
  const Wide a = metric.uu - 1.0f, b = metric.vv - 1.0f;
  const Wide trace = a + b, mixed = 2.0f * max(metric.uv * metric.uv - a * b, Wide{});
  const Wide reciprocal = 1.0f / sqrt(trace * trace + 2.0f * mixed + kTiny);
  const Wide share = 0.5f + 0.5f * trace * reciprocal, more = 1.0f + 0.5f * mixed * reciprocal;
  return {more + share * a, more + share * b, share * metric.uv};
}

// x in M x = r by LDLᵀ; M positive, told by its diagonal and 01, 02, 12.
WEFT_INLINE Three solved(const Wide (&diagonal)[3], Wide m01, Wide m02, Wide m12, const Three& r) {
  const Wide i0 = 1.0f / diagonal[0], l1 = m01 * i0, l2 = m02 * i0;
  const Wide i1 = 1.0f / max(diagonal[1] - l1 * m01, kLeastPivot * diagonal[1]);
  const Wide rest = m12 - l2 * m01, l3 = rest * i1;
  const Wide i2 = 1.0f / max(diagonal[2] - l2 * m02 - l3 * rest, kLeastPivot * diagonal[2]);
  const Wide y1 = r.of[1] - l1 * r.of[0], y2 = r.of[2] - l2 * r.of[0] - l3 * y1;
  const Wide x2 = y2 * i2, x1 = y1 * i1 - l3 * x2;
  return {{r.of[0] * i0 - l1 * x1 - l2 * x2, x1, x2}};
}

// Lanes from `lane` on of one batch.
struct Triangles {
  const StrainSweep& s;
  const StrainBatch& b;
  int lane;

  WEFT_INLINE Wide3 along(const Wide3& p, const Wide3& q, const float (&d)[2][kBatch]) const {
    return p * load(d[0] + lane) + q * load(d[1] + lane);
  }
  WEFT_INLINE Derivatives derivatives(const Wide3& a, const Wide3& c, const Wide3& d) const {
    const Wide3 p = c - a, q = d - a;
    return {along(p, q, b.du), along(p, q, b.dv)};
  }
  WEFT_INLINE Three strains_before() const {
    const auto at = [&](int k) {
      return records_from([&](int l) { return s.before + b.corner[k][lane + l]; }).xyz;
    };
    return strains(derivatives(at(0), at(1), at(2)).metric());
  }

  // Δs by the residual r.
  WEFT_INLINE Three step(const Two& metric, Wide scale, const Wide (&w)[3], const Three& r) const {
    const Wide u1 = load(b.du[0] + lane), u2 = load(b.du[1] + lane);
    const Wide v1 = load(b.dv[0] + lane), v2 = load(b.dv[1] + lane);
    const Wide u0 = u1 + u2, v0 = v1 + v2;
    const Two g{scale * (w[0] * u0 * u0 + w[1] * u1 * u1 + w[2] * u2 * u2),
                scale * (w[0] * v0 * v0 + w[1] * v1 * v1 + w[2] * v2 * v2),
                scale * (w[0] * u0 * v0 + w[1] * u1 * v1 + w[2] * u2 * v2)};
    const Two m = raised(metric);
    const Wide sheared = m.uu * g.vv + m.vv * g.uu + 2.0f * m.uv * g.uv;
    const Wide diagonal[3] = {m.uu * g.uu + s.give[0], m.vv * g.vv + s.give[1],
                              sheared + s.give[3]};
    return solved(diagonal, m.uv * g.uv + s.give[2], m.uu * g.uv + m.uv * g.uu,
                  m.uv * g.vv + m.vv * g.uv, r);
  }

  // Adds C⁻¹ s.
  WEFT_INLINE void add_give(const Three& stress, Three& r) const {
    r.of[0] = r.of[0] + s.give[0] * stress.of[0] + s.give[2] * stress.of[1];
    r.of[1] = r.of[1] + s.give[2] * stress.of[0] + s.give[1] * stress.of[1];
    r.of[2] = r.of[2] + s.give[3] * stress.of[2];
  }
};

// Whether damping is in a sweep, or a sweep of damping is before the others.
enum class Damping { none, in_one, alone };

// kMidst: tells how long sides are in the mean of before and after (mesh_sweeps.cpp).
template <bool kMultipliers, Damping kDamping, bool kMidst>
WEFT_INLINE void solve(const Triangles& t, float* stress, float* midst) {
  const StrainSweep& s = t.s;
  Wide3 x[3];
  Wide w[3];
  for (int k = 0; k < 3; ++k) {
    const std::int32_t* const corner = t.b.corner[k] + t.lane;
    const Wide4 at = records_from([&](int l) { return s.records + corner[l]; },
                                  [](const float* r) { return load_four(r) + load_four(r + 4); });
    x[k] = at.xyz;
    w[k] = at.last;
  }
  const Derivatives d = t.derivatives(x[0], x[1], x[2]);
  const Two metric = d.metric();
  Three r = strains(metric);
  Wide scale = load(t.b.area + t.lane) * s.dt2;
  if constexpr (kDamping != Damping::none) {
    const Three before = t.strains_before();
    for (int n = 0; n < kStrains; ++n) {
      const Wide gained = s.rate * (r.of[n] - before.of[n]);
      r.of[n] = kDamping == Damping::alone ? gained : r.of[n] + gained;
    }
  }
  Three held{};
  if constexpr (kMultipliers)
    if (!s.fresh) {
      for (int n = 0; n < kStrains; ++n) held.of[n] = load(stress + n * kBatch + t.lane);
      t.add_give(held, r);
    }
  const Wide inertia = kDamping == Damping::none    ? scale
                       : kDamping == Damping::alone ? scale * s.rate
                                                    : scale * (1.0f + s.rate);
  const Three by = t.step(metric, inertia, w, r);
  if constexpr (kMultipliers)
    for (int n = 0; n < kStrains; ++n) store(stress + n * kBatch + t.lane, held.of[n] - by.of[n]);
  const Wide3 p = (d.u * by.of[0] + d.v * by.of[2]) * scale;
  const Wide3 q = (d.u * by.of[2] + d.v * by.of[1]) * scale;
  const Wide3 one = p * load(t.b.du[0] + t.lane) + q * load(t.b.dv[0] + t.lane);
  const Wide3 two = p * load(t.b.du[1] + t.lane) + q * load(t.b.dv[1] + t.lane);
  const Wide3 moved[3] = {(one + two) * w[0], one * (-w[1]), two * (-w[2])};
  for (int k = 0; k < 3; ++k) add_records(s.records + 4, 1, t.b.corner[k] + t.lane, moved[k]);
  if constexpr (kMidst)
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const Wide3 side = fma(moved[next] - moved[k], wide(0.5f), x[next] - x[k]);
      store(midst + k * kBatch + t.lane, dot(side, side));
    }
}

template <bool kMultipliers, Damping kDamping, bool kMidst>
void sweep(const StrainSweep& given) {
  const StrainSweep s = given;  // a copy that no store can alias
  for (int n = 0; n < s.count; ++n)
    for (int lane = 0; lane < kBatch; lane += kLanes)
      solve<kMultipliers, kDamping, kMidst>(
          {s, s.batches[n], lane},
          kMultipliers ? s.stress + std::ptrdiff_t(n) * kStrains * kBatch : nullptr,
          kMidst ? s.midst + std::ptrdiff_t(n) * 3 * kBatch : nullptr);
}

template <bool kMidst>
void sweep(const StrainSweep& s) {
  if (s.before)
    return s.stress ? sweep<true, Damping::in_one, kMidst>(s)
                    : sweep<false, Damping::in_one, kMidst>(s);
  s.stress ? sweep<true, Damping::none, kMidst>(s) : sweep<false, Damping::none, kMidst>(s);
}

}  // namespace

void sweep_strains(const StrainSweep& s) {
  if (s.damps)
    return s.stress ? sweep<true, Damping::alone, false>(s)
                    : sweep<false, Damping::alone, false>(s);
  s.midst ? sweep<true>(s) : sweep<false>(s);
}

}  // namespace weft::WEFT_KERNELS
