// Constraints by projection: position based dynamics and its compliant form (XPBD).
//
//   C = |e| - l,  Δλ = (C + α̃ λ)/(w_a + w_b + α̃),  α̃ = 1/(k dt²),  λ <- λ - Δλ
//   x_a <- x_a + w_a Δλ e/|e|,  x_b <- x_b - w_b Δλ e/|e|,  e = x_b - x_a
//
// (Macklin, Müller, Chentanez 2016, "XPBD"; with α̃ = 0 seed 000's positional constraint for unequal
// masses. Gauss–Seidel takes one colour of one family at a time, all of whose constraints are
// disjoint; Jacobi adds up the corrections of all families and applies them at the end of a sweep.)
#include <cstddef>

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

constexpr float kTiny = 1e-30f;

struct RowAt {
  Row3 x, v;
  const float* w;
};

WEFT_INLINE RowAt row_at(const ProjectRows& p, int j) {
  const std::ptrdiff_t at = std::ptrdiff_t(j) * p.stride;
  return {{p.x.x + at, p.x.y + at, p.x.z + at}, {p.v.x + at, p.v.y + at, p.v.z + at}, p.w + at};
}

// What differs between the sweeps, so that each kernel holds just its own.
enum class Rule { rigid, compliant, multipliers, limit };

// Δλ/|e| of a block of constraints of given length, zero outside `active`; updates the multipliers.
template <Rule R>
WEFT_INLINE Wide scale_of(const ProjectRows& p, Wide length, Wide wa, Wide wb, int j, Wide& lambda,
                          WideInt active) {
  Wide violation = length - p.rest, inertia = (wa + wb) * p.weight;
  if constexpr (R == Rule::compliant || R == Rule::multipliers)
    inertia = inertia + p.compliance[j];
  else
    active = active & (inertia > 0.0f);  // two pinned ends have nothing to move
  if constexpr (R == Rule::limit) active = active & (violation > 0.0f);
  if constexpr (R == Rule::multipliers) violation = violation + p.compliance[j] * lambda;
  const Wide scale = select(active, violation / (inertia * length), Wide{});
  if constexpr (R == Rule::multipliers) lambda = lambda - scale * length;
  return scale;
}

// The correction of a block of constraints by unit inverse mass; e joins their ends.
template <Rule R>
WEFT_INLINE Wide3 solve(const ProjectRows& p, Wide3 e, Wide wa, Wide wb, int j, Wide& lambda,
                        WideInt active) {
  const Wide length = sqrt(max(dot(e, e), wide(kTiny)));
  return e * scale_of<R>(p, length, wa, wb, j, lambda, active);
}

// The same for constraints a … a+kLanes-1 of rows `near` and `far`.
template <Rule R>
WEFT_INLINE Wide3 solve_block(const ProjectRows& p, const RowAt& near, const RowAt& far, Wide wa,
                              Wide wb, int j, int a, WideInt active) {
  const Wide3 e = load3(far.x, a + p.far) - load3(near.x, a + p.near);
  Wide lambda{};
  float* at = nullptr;
  if constexpr (R == Rule::multipliers) {
    at = p.lambda + std::ptrdiff_t(j) * p.stride + a;
    lambda = load(at);
  }
  const Wide3 c = solve<R>(p, e, wa, wb, j, lambda, active);
  if constexpr (R == Rule::multipliers) store(at, lambda);
  return c;
}

template <Rule R>
WEFT_INLINE void shift(const ProjectRows& p, const RowAt& row, int i, Wide3 change) {
  store3(row.x, i, load3(row.x, i) + change);
  if constexpr (R != Rule::rigid)
    store3(row.v, i, load3(row.v, i) + change * wide(p.inverse_dt));
}

// Whether the strain limit has anything to do in a block.
WEFT_INLINE bool moves(Wide3 c) {
  const WideInt some = (c.x != 0.0f) | (c.y != 0.0f) | (c.z != 0.0f);
  return any(some);
}

WEFT_INLINE WideInt lanes_of(const std::int32_t* lanes) {
  typedef WideInt Loose __attribute__((aligned(4), may_alias));
  return *reinterpret_cast<const Loose*>(lanes);
}

template <Rule R, class DelayType>
WEFT_INLINE void along_row(const ProjectRows& p, int j, int first, const std::int32_t* lanes,
                           DelayType delay) {
  const RowAt row = row_at(p, j);
  for (int a = first; a < p.count + p.far; a += kLanes) {
    const Wide wa = load(row.w + a), wb = load(row.w + a + p.far);
    const Wide3 c = solve_block<R>(p, row, row, wa, wb, j, a, lanes_of(lanes + a));
    const Wide3 change = c * wa - delay.next(c * wb);
    if (R == Rule::limit && !moves(change)) continue;
    shift<R>(p, row, a, change);
  }
}

// Constraints (i, i+N) of one colour along a row fill every other group of N lanes. Two blocks of
// lanes are parted into near and far ends, solved without a lane idle, and woven together again.
template <int N>
struct Parting {
  Wide near, far;
  WEFT_INLINE explicit Parting(const float* p)
      : Parting(load(p), load(p + kLanes), std::make_integer_sequence<int, kLanes>{}) {}
  WEFT_INLINE Parting(Wide near_ends, Wide far_ends) : near(near_ends), far(far_ends) {}
  WEFT_INLINE void weave(float* p) const { weave(p, std::make_integer_sequence<int, kLanes>{}); }

 private:
  // Lane l of the near ends lies in lane place(l) of the two blocks, its far end N lanes on.
  static constexpr int place(int l) { return l / N * 2 * N + l % N; }
  // Lane m of the two blocks holds near end index(m), or kLanes + far end.
  static constexpr int index(int m) {
    return m / (2 * N) * N + m % N + (m / N % 2 == 0 ? 0 : kLanes);
  }
  template <int... L>
  WEFT_INLINE Parting(Wide a, Wide b, std::integer_sequence<int, L...>)
      : near(__builtin_shufflevector(a, b, place(L)...)),
        far(__builtin_shufflevector(a, b, (place(L) + N)...)) {}
  template <int... L>
  WEFT_INLINE void weave(float* p, std::integer_sequence<int, L...>) const {
    store(p, __builtin_shufflevector(near, far, index(L)...));
    store(p + kLanes, __builtin_shufflevector(near, far, index(L + kLanes)...));
  }
};

// Numbers of the near lanes of a parting, as offsets from its first lane.
template <int N>
WEFT_INLINE WideInt near_lanes() {
  const WideInt l = lane_numbers();
  return l / N * (2 * N) + l % N;
}

// All constraints that lie whole blocks from the row's end; returns the first left over.
template <Rule R, int N>
WEFT_INLINE int along_row_parted(const ProjectRows& p, int j, int colour) {
  const RowAt row = row_at(p, j);
  float* const axes[3] = {row.x.x, row.x.y, row.x.z};
  float* const velocities[3] = {row.v.x, row.v.y, row.v.z};
  int a = colour * N;
  for (; a < p.count && a + 2 * kLanes <= p.stride; a += 2 * kLanes) {
    const Parting<N> x(axes[0] + a), y(axes[1] + a), z(axes[2] + a), w(row.w + a);
    const Wide3 e{x.far - x.near, y.far - y.near, z.far - z.near};
    const WideInt active = near_lanes<N>() < p.count - a;
    Wide lambda{};
    float* const at = p.lambda + std::ptrdiff_t(j) * p.stride + a;
    Wide others{};
    if constexpr (R == Rule::multipliers) {
      const Parting<N> both(at);
      lambda = both.near;
      others = both.far;
    }
    const Wide3 c = solve<R>(p, e, w.near, w.far, j, lambda, active);
    if constexpr (R == Rule::multipliers) Parting<N>(lambda, others).weave(at);
    if (R == Rule::limit && !moves(c)) continue;
    const Wide3 near = c * w.near, far = c * w.far;
    Parting<N>(x.near + near.x, x.far - far.x).weave(axes[0] + a);
    Parting<N>(y.near + near.y, y.far - far.y).weave(axes[1] + a);
    Parting<N>(z.near + near.z, z.far - far.z).weave(axes[2] + a);
    if constexpr (R != Rule::rigid) {
      const Wide3 change[2] = {near * wide(p.inverse_dt), far * wide(p.inverse_dt)};
      const Parting<N> vx(velocities[0] + a), vy(velocities[1] + a), vz(velocities[2] + a);
      Parting<N>(vx.near + change[0].x, vx.far - change[1].x).weave(velocities[0] + a);
      Parting<N>(vy.near + change[0].y, vy.far - change[1].y).weave(velocities[1] + a);
      Parting<N>(vz.near + change[0].z, vz.far - change[1].z).weave(velocities[2] + a);
    }
  }
  return a;
}

// The constraints between rows j and j+dj. Blocks pass three stations (edge, root, shift), each a
// block behind the one before, so that no root is waited for.
template <Rule R>
WEFT_INLINE void between_rows(const ProjectRows& p, int j) {
  // Lane a of these is an end of constraint a.
  const auto shifted = [](RowAt r, int by) {
    return RowAt{{r.x.x + by, r.x.y + by, r.x.z + by}, {r.v.x + by, r.v.y + by, r.v.z + by}, r.w + by};
  };
  const RowAt near = shifted(row_at(p, j), p.near), far = shifted(row_at(p, j + p.dj), p.far);
  struct Block {
    Wide3 e;
    Wide length;
  } squared{}, rooted{};
  float* const lambdas = p.lambda + std::ptrdiff_t(j) * p.stride;
  const int count = p.count, end = padded(count);
  for (int a = 0; a < end + 2 * kLanes; a += kLanes) {
    if (const int i = a - 2 * kLanes; i >= 0) {
      const Wide wa = load(near.w + i), wb = load(far.w + i);
      Wide lambda{};
      if constexpr (R == Rule::multipliers) lambda = load(lambdas + i);
      const Wide scale =
          scale_of<R>(p, rooted.length, wa, wb, j, lambda, lanes_below(count - i));
      if constexpr (R == Rule::multipliers) store(lambdas + i, lambda);
      const Wide3 c = rooted.e * scale;
      if (R != Rule::limit || moves(c)) {
        shift<R>(p, near, i, c * wa);
        shift<R>(p, far, i, Wide3{} - c * wb);
      }
    }
    if (const int i = a - kLanes; i >= 0 && i < end) {
      rooted.e = squared.e;
      rooted.length = sqrt(squared.length);
    }
    if (a < end) {
      squared.e = load3(far.x, a) - load3(near.x, a);
      squared.length = max(dot(squared.e, squared.e), wide(kTiny));
    }
  }
}

// Rows begin … end-1 of one family: along the rows one colour after the other, between rows those of
// one colour.
template <Rule R>
void sweep(const ProjectRows& given) {
  const ProjectRows p = given;
  if (p.dj == 0) {
    for (int colour = 0; colour < 2; ++colour)
      for (int j = p.begin; j < p.end; ++j) {
        const std::int32_t* lanes = p.lanes + std::ptrdiff_t(colour) * p.stride;
        int a = 0;
        if (p.far == 1) a = along_row_parted<R, 1>(p, j, colour);
        if (p.far == 2 && kLanes > 1) a = along_row_parted<R, kLanes == 1 ? 1 : 2>(p, j, colour);
        if (a < p.count) along_row<R>(p, j, a, lanes, LongDelay3(p.far));
      }
    return;
  }
  for (int j = p.begin; j < p.end; ++j)
    if (j / p.dj % 2 == p.colour && j + p.dj < p.rows) between_rows<R>(p, j);
}

// Adds the corrections of row j's constraints of one family to the sums of both rows.
template <Rule R, class DelayType>
WEFT_INLINE void sum_along(const ProjectRows& p, int j, Row3 sum, DelayType delay) {
  const RowAt row = row_at(p, j);
  for (int a = 0; a < padded(p.count + p.far); a += kLanes) {
    const Wide wa = load(row.w + a), wb = load(row.w + a + p.far);
    const Wide3 c = solve_block<R>(p, row, row, wa, wb, j, a, lanes_below(p.count - a));
    store3(sum, a, load3(sum, a) + (c * wa - delay.next(c * wb)));
  }
}

template <Rule R>
void sum_family(const ProjectRows& p, int j, Row3 sum, Row3 sum_far) {
  if (p.dj == 0) {
    if (p.far == 1) return sum_along<R>(p, j, sum, Delay3<1>{});
    if (p.far == 2) return sum_along<R>(p, j, sum, Delay3<2>{});
    return sum_along<R>(p, j, sum, LongDelay3(p.far));
  }
  const RowAt near = row_at(p, j), far = row_at(p, j + p.dj);
  for (int a = 0; a < padded(p.count); a += kLanes) {
    const Wide wa = load(near.w + a + p.near), wb = load(far.w + a + p.far);
    const Wide3 c = solve_block<R>(p, near, far, wa, wb, j, a, lanes_below(p.count - a));
    store3(sum, a + p.near, load3(sum, a + p.near) + c * wa);
    store3(sum_far, a + p.far, load3(sum_far, a + p.far) - c * wb);
  }
}

}  // namespace

void project(const ProjectRows& p) {
  if (p.limit) return sweep<Rule::limit>(p);
  if (p.lambda) return sweep<Rule::multipliers>(p);
  if (p.compliance) return sweep<Rule::compliant>(p);
  sweep<Rule::rigid>(p);
}

void project_jacobi(const ProjectRows& p, int j, Row3 sum, Row3 sum_far) {
  if (p.lambda) return sum_family<Rule::multipliers>(p, j, sum, sum_far);
  if (p.compliance) return sum_family<Rule::compliant>(p, j, sum, sum_far);
  sum_family<Rule::rigid>(p, j, sum, sum_far);
}

void apply_corrections(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    store3(r.x, i, load3(r.x, i) + load3(r.f, i));
    if (r.inverse_dt > 0) store3(r.v, i, load3(r.v, i) + load3(r.f, i) * wide(r.inverse_dt));
    store3(r.f, i, Wide3{});
  }
}

void predict(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    store3(r.previous, i, load3(r.x, i));
    move(r.x, r.v, r.w, Wide3{}, r.advance, i);
  }
}

void velocity(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes)
    store3(r.v, i, (load3(r.x, i) - load3(r.previous, i)) * wide(r.inverse_dt));
}

}  // namespace weft::WEFT_KERNELS
