// Gauss–Seidel over the constraints of a mesh, those of a batch side by side: edges as in gauss_seidel.cpp,
//
//   C = |e| - l,  Δλ = (C + α̃ λ)/(w_a + w_b + α̃),  α̃ = 1/(k dt²),  λ <- λ - Δλ
//   x_a <- x_a + w_a Δλ e/|e|,  x_b <- x_b - w_b Δλ e/|e|,  e = x_b - x_a
//
// and the bending of triangles, whose jumps of slope J = Σ a_i x_i are linear in the positions (Bergou et al.
// 2006, "A quadratic bending model for inextensible surfaces"): Δλ = -P J with one matrix for all motion,
// x_i <- x_i + w_i Σ_k a_ki Δλ_k.
#include "physics/kernels/hinges.h"
#include "physics/kernels/kept.h"
#include "physics/kernels/mesh_sweep.h"
#include "physics/kernels/projection.h"
#include "physics/kernels/records.h"

namespace weft::WEFT_KERNELS {
namespace {

using physics::EdgeBatch;
using physics::EdgeSweep;
using physics::HingeSweep;
using physics::kRecord;
using physics::RecordRow;

// Where kLanes vertices are, and their inverse masses: one sum of two halves of a record for each.
WEFT_INLINE Wide4 vertices_at(const float* records, const std::int32_t* offset) {
  return records_from([&](int k) { return records + offset[k]; },
                      [](const float* at) { return load_four(at) + load_four(at + 4); });
}

WEFT_INLINE void correct(float* records, const std::int32_t* offset, Wide3 by) {
  add_records(records + 4, 1, offset, by);
}

// Lanes from `lane` on of one batch. kMidst: tells lengths in the mean of before and after the correction. Where
// sweeps are few, constraints solved last are at rest and others have all that these have lost. In the mean a
// constraint is as long as its force by the compliance and half of the inertia makes it, and the forces are in
// balance.
template <Rule R, bool kMidst>
WEFT_INLINE void project_edges(const EdgeSweep& s, const EdgeBatch& b, int n, int lane) {
  float* const lambda = s.lambda + std::ptrdiff_t(n) * physics::kBatch;
  const Wide4 p = vertices_at(s.records, b.near + lane), q = vertices_at(s.records, b.far + lane);
  const Wide3 e = q.xyz - p.xyz;
  Wide rest = load(b.rest + lane), inertia = p.last + q.last;
  const Wide squared = squared_length(e);
  WideInt active = inertia > 0.0f;
  if constexpr (R == Rule::limit) {
    rest = rest * s.longest;
    active = active & (squared > rest * rest);
    if (!any(active)) return;
  }
  const Wide length = sqrt(squared);
  Wide violation = length - rest;
  if constexpr (R != Rule::limit) {
    const Wide compliance = load(b.give + lane) * s.inverse_dt2;
    inertia = inertia + compliance;
    if constexpr (R == Rule::multipliers)
      if (!s.fresh) violation = fma(compliance, load(lambda + lane), violation);
  }
  const Wide scale = select(active, violation / (inertia * length), Wide{});
  if constexpr (R == Rule::multipliers) {
    const Wide before = s.fresh ? Wide{} : load(lambda + lane);
    store(lambda + lane, fnma(scale, length, before));
  }
  const Wide3 pull = e * scale;
  if constexpr (kMidst)
    store(s.midst + std::ptrdiff_t(n) * physics::kBatch + lane,
          squared_length(fnma(pull, (p.last + q.last) * 0.5f, e)));
  correct(s.records, b.near + lane, pull * p.last);
  correct(s.records, b.far + lane, pull * (-q.last));
}

template <Rule R, bool kMidst>
void sweep(const EdgeSweep& given) {
  const EdgeSweep s = given;  // a copy that no store can alias
  for (int n = 0; n < s.count; ++n)
    for (int lane = 0; lane < physics::kBatch; lane += kLanes)
      project_edges<R, kMidst>(s, s.batches[n], n, lane);
}

void store_records_finely(const RecordRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 change = records_in_row(r.records + std::ptrdiff_t(kRecord) * i + 4, kRecord).xyz;
    Kept x{load3(r.x, i), load3(r.left, i)}, v{load3(r.v, i), load3(r.v_left, i)};
    x.move<true>(change);
    v.move<true>(change * wide(r.inverse_dt));
    store3(r.x, i, x.value);
    store3(r.v, i, v.value);
    store3(r.left, i, x.left);
    store3(r.v_left, i, v.left);
  }
}

}  // namespace

void load_records(const RecordRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    float* const at = r.records + std::ptrdiff_t(kRecord) * i;
    put_records(at, kRecord, {load3(r.x, i), Wide{}});
    put_records(at + 4, kRecord, {Wide3{}, load(r.w + i)});
  }
}

void store_records(const RecordRow& r) {
  if (r.left.x) return store_records_finely(r);
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 change = records_in_row(r.records + std::ptrdiff_t(kRecord) * i + 4, kRecord).xyz;
    store3(r.x, i, load3(r.x, i) + change);
    store3(r.v, i, fma(change, wide(r.inverse_dt), load3(r.v, i)));
  }
}

void sweep_edges(const EdgeSweep& s) {
  if (s.longest > 0) return sweep<Rule::limit, false>(s);
  if (s.midst)
    return s.lambda ? sweep<Rule::multipliers, true>(s) : sweep<Rule::compliant, true>(s);
  s.lambda ? sweep<Rule::multipliers, false>(s) : sweep<Rule::compliant, false>(s);
}

void sweep_hinges(const HingeSweep& s) {
  for (int n = 0; n < s.count; ++n)
    for (int lane = 0; lane < physics::kBatch; lane += kLanes) {
      const Hinges hinges{s.batches[n], lane};
      Wide4 at[6];
      for (int k = 0; k < 6; ++k) at[k] = vertices_at(s.records, hinges.b.corner[k] + lane);
      Wide3 jump[3], own[3] = {}, across[3];
      hinges.jumps({at[0].xyz, at[1].xyz, at[2].xyz, at[3].xyz, at[4].xyz, at[5].xyz}, jump);
      const Wide3 p = at[1].xyz - at[0].xyz, q = at[2].xyz - at[0].xyz;
      if (s.bows) hinges.take_off_rest(p, q, jump);
      hinges.pull(jump, own, across);
      if (s.bows) hinges.turn(jump, p, q, own);
      for (int k = 0; k < 3; ++k) {
        correct(s.records, hinges.b.corner[k] + lane, own[k] * at[k].last);
        correct(s.records, hinges.b.corner[3 + k] + lane, across[k] * at[3 + k].last);
      }
    }
}

}  // namespace weft::WEFT_KERNELS
