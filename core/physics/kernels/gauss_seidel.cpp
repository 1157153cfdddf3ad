// Gauss–Seidel: constraints by projection, one colour of one family at a time, all of whose
// constraints are disjoint. Position based dynamics and its compliant form (XPBD):
//
//   C = |e| - l,  Δλ = (C + α̃ λ)/(w_a + w_b + α̃),  α̃ = 1/(k dt²),  λ <- λ - Δλ
//   x_a <- x_a + w_a Δλ e/|e|,  x_b <- x_b - w_b Δλ e/|e|,  e = x_b - x_a
//
// (Macklin, Müller, Chentanez 2016, "XPBD"; with α̃ = 0 seed 000's positional constraint for unequal
// masses.)
#include "physics/kernels/projection.h"

namespace weft::WEFT_KERNELS {
namespace {

// What differs between the sweeps, so that each kernel holds just its own.
enum class Rule { rigid, compliant, multipliers, limit };
constexpr bool displaced(Rule r) {
  return r == Rule::compliant || r == Rule::multipliers;
}

// The correction of constraints of row j by unit inverse mass, zero outside `active`.
template <Rule R>
WEFT_INLINE Wide3 solve(const ProjectRows& p, Wide3 e, Wide wa, Wide wb, int j, Wide& lambda,
                        WideInt active) {
  const Wide length = sqrt(squared_length(e));
  Wide violation = length - p.rest, inertia = (wa + wb) * p.weight;
  if constexpr (displaced(R))
    inertia = inertia + p.compliance[j];
  else
    active = active & (inertia > 0.0f);  // two pinned ends have nothing to move
  if constexpr (R == Rule::limit) active = active & (violation > 0.0f);
  if constexpr (R == Rule::multipliers) violation = fma(wide(p.compliance[j]), lambda, violation);
  const Wide scale = select(active, violation / (inertia * length), Wide{});
  if constexpr (R == Rule::multipliers) lambda = fnma(scale, length, lambda);
  return e * scale;
}

// The same for constraints a … a+kLanes-1 between the lanes of two rows.
template <Rule R>
WEFT_INLINE Wide3 solve_block(const ProjectRows& p, const ProjectedRow& near,
                              const ProjectedRow& far, Wide wa, Wide wb, int j, int a,
                              WideInt active) {
  const Wide3 e = position<displaced(R)>(far, a) - position<displaced(R)>(near, a);
  if constexpr (R == Rule::limit) {
    // Most blocks have nothing too long: the root is not worth taking there.
    if (!any(active & (dot(e, e) > p.rest * p.rest))) return Wide3{};
  }
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

// The strain limit changes positions and velocities together, and seldom anything at all.
template <Rule R>
WEFT_INLINE void move_end(const ProjectRows& p, const ProjectedRow& r, int i, Wide3 change) {
  if constexpr (R == Rule::limit) {
    const WideInt some = (change.x != 0.0f) | (change.y != 0.0f) | (change.z != 0.0f);
    if (!any(some)) return;
    const std::ptrdiff_t at = r.x.x + i - p.x.x;
    const Row3 v{p.v.x + at, p.v.y + at, p.v.z + at};
    store3(v, 0, load3(v, 0) + change * wide(p.inverse_dt));
  }
  shift<displaced(R)>(r, i, change);
}

// One colour along row j, whatever the offset: the lanes of the other colour stand by.
template <Rule R, bool kTorn>
WEFT_INLINE void along_row(const ProjectRows& p, int j, int colour) {
  const ProjectedRow near = projected_row(p, j, 0), far = projected_row(p, j, p.far);
  const std::int32_t* const lanes = p.lanes + std::ptrdiff_t(colour) * p.stride;
  LongDelay3 delay(p.far);
  for (int a = 0; a < p.count + p.far; a += kLanes) {
    const Wide wa = load(near.w + a), wb = load(far.w + a);
    WideInt active = lanes_at(lanes + a);
    if constexpr (kTorn) active = active & alive_lanes(p, j, a);
    const Wide3 c = solve_block<R>(p, near, far, wa, wb, j, a, active);
    move_end<R>(p, near, a, c * wa - delay.next(c * wb));
  }
}

// The constraints between rows j and j+dj.
template <Rule R, bool kTorn>
WEFT_INLINE void between_rows(const ProjectRows& p, int j) {
  const ProjectedRow near = projected_row(p, j, p.near), far = projected_row(p, j + p.dj, p.far);
  for (int a = 0; a < p.count; a += kLanes) {
    const Wide wa = load(near.w + a), wb = load(far.w + a);
    WideInt active = lanes_below(p.count - a);
    if constexpr (kTorn) active = active & alive_lanes(p, j, a);
    const Wide3 c = solve_block<R>(p, near, far, wa, wb, j, a, active);
    move_end<R>(p, near, a, c * wa);
    move_end<R>(p, far, a, Wide3{} - c * wb);
  }
}

// The same between rows whose particles all have the inverse mass of c.
template <Rule R>
class BetweenRowsAlike {
 public:
  WEFT_INLINE BetweenRowsAlike(const ProjectRows& p, int j, const Alike& c)
      : count_(p.count),
        c_(c),
        near_(projected_row(p, j, p.near)),
        far_(projected_row(p, j + p.dj, p.far)),
        lambdas_(p.lambda + std::ptrdiff_t(j) * p.stride) {}

  // Two blocks side by side, 16 lanes apart at any width, so that neither waits for its root alone.
  WEFT_INLINE void run() const {
    for (int a = 0; a < count_; a += 32)
      for (int b = a; b < a + 16; b += kLanes)
        if (b + 16 < count_)
          blocks<2>(b);
        else if (b < count_)
          blocks<1>(b);
  }

 private:
  static constexpr bool kMultipliers = R == Rule::multipliers, kDisplaced = displaced(R);

  template <int K>
  WEFT_INLINE void blocks(int first) const {
    Wide3 e[K];
    for (int k = 0; k < K; ++k) {
      const int a = first + k * 16;
      e[k] = position<kDisplaced>(far_, a) - position<kDisplaced>(near_, a);
    }
    Wide lambda[K], scale[K];
    if constexpr (kMultipliers)
      for (int k = 0; k < K; ++k) lambda[k] = load(lambdas_ + first + k * 16);
    const Wide before = lambda[K - 1];
    scales_alike<kMultipliers, K>(c_, e, lambda, scale);
    if (const int last = first + (K - 1) * 16; last + kLanes > count_) {
      const WideInt active = lanes_below(count_ - last);
      scale[K - 1] = select(active, scale[K - 1], Wide{});
      lambda[K - 1] = select(active, lambda[K - 1], before);
    }
    for (int k = 0; k < K; ++k) {
      const int a = first + k * 16;
      if constexpr (kMultipliers) store(lambdas_ + a, lambda[k]);
      const Row3 near = kDisplaced ? near_.u : near_.x, far = kDisplaced ? far_.u : far_.x;
      store3(near, a, fma(e[k], scale[k], load3(near, a)));
      store3(far, a, fnma(e[k], scale[k], load3(far, a)));
    }
  }

  const int count_;
  const Alike& c_;
  const ProjectedRow near_, far_;
  float* const lambdas_;
};

// Both colours along row j, N lanes from end to end. Two blocks at a time take their first colour;
// the second, which reaches into the next two blocks, follows behind.
template <Rule R, int N>
class AlongRowAlike {
 public:
  WEFT_INLINE AlongRowAlike(const ProjectRows& p, int j, const Alike& c)
      : p_(p),
        c_(c),
        row_(projected_row(p, j, 0)),
        lambdas_(p.lambda + std::ptrdiff_t(j) * p.stride) {}

  // Two pairs of blocks behind, so that neither colour waits for the other's roots.
  WEFT_INLINE void run() {
    constexpr int kPair = 2 * kLanes;
    const int end = p_.count + N;
    Blocks last = first_colour(0), before{};
    int a = kPair;
    if (a < end) {
      before = last;
      last = first_colour(a);
    }
    for (a += kPair; a < end; a += kPair) {
      const Blocks now = first_colour(a);
      second_colour(before, last, a - 2 * kPair);
      before = last;
      last = now;
    }
    if (end > kPair) second_colour(before, last, a - 2 * kPair);
    second_colour(last, Blocks{}, end > kPair ? a - kPair : 0);
  }

 private:
  // Two blocks, parted: positions, and what is to be stored in the end (positions or corrections).
  struct Blocks {
    Parting<N> base[3], moved[3], lambda;
  };
  static constexpr bool kMultipliers = R == Rule::multipliers, kDisplaced = displaced(R);

  WEFT_INLINE static Wide near_end(const Blocks& b, int k) {
    return kDisplaced ? b.base[k].near + b.moved[k].near : b.moved[k].near;
  }
  WEFT_INLINE static Wide far_end(const Blocks& b, int k) {
    return kDisplaced ? b.base[k].far + b.moved[k].far : b.moved[k].far;
  }
  WEFT_INLINE Wide scale(Wide3 e, Wide& lambda, int a) const {
    const Wide before = lambda;
    Wide s;
    scales_alike<kMultipliers, 1>(c_, &e, &lambda, &s);
    if (a + 2 * kLanes > p_.count) {
      const WideInt active = Parting<N>::numbers() < p_.count - a;
      s = select(active, s, Wide{});
      lambda = select(active, lambda, before);
    }
    return s;
  }

  WEFT_INLINE Blocks first_colour(int a) const {
    Blocks b;
    const float* const x[3] = {row_.x.x, row_.x.y, row_.x.z};
    const float* const u[3] = {row_.u.x, row_.u.y, row_.u.z};
    for (int k = 0; k < 3; ++k) {
      if constexpr (kDisplaced) b.base[k] = Parting<N>(x[k] + a);
      b.moved[k] = Parting<N>((kDisplaced ? u[k] : x[k]) + a);
    }
    if constexpr (kMultipliers) b.lambda = Parting<N>(lambdas_ + a);
    const Wide3 e{far_end(b, 0) - near_end(b, 0), far_end(b, 1) - near_end(b, 1),
                  far_end(b, 2) - near_end(b, 2)};
    const Wide s = scale(e, b.lambda.near, a);
    const Wide change[3] = {e.x * s, e.y * s, e.z * s};
    for (int k = 0; k < 3; ++k) {
      b.moved[k].near = b.moved[k].near + change[k];
      b.moved[k].far = b.moved[k].far - change[k];
    }
    return b;
  }

  // The lanes of `a` from lane N on, followed by the first N of `b`.
  template <int... L>
  WEFT_INLINE static Wide next(Wide a, Wide b, std::integer_sequence<int, L...>) {
    return __builtin_shufflevector(a, b, (L + N)...);
  }
  // The last N lanes of `a`, followed by the others of `b`.
  template <int... L>
  WEFT_INLINE static Wide past(Wide a, Wide b, std::integer_sequence<int, L...>) {
    return __builtin_shufflevector(a, b, (L + kLanes - N)...);
  }

  // From the far ends of b, whose first lane is a, to the near ends that follow; stores b.
  WEFT_INLINE void second_colour(Blocks b, const Blocks& after, int a) {
    constexpr auto lanes = std::make_integer_sequence<int, kLanes>{};
    Wide e[3];
    for (int k = 0; k < 3; ++k)
      e[k] = next(near_end(b, k), near_end(after, k), lanes) - far_end(b, k);
    const Wide s = scale({e[0], e[1], e[2]}, b.lambda.far, a + N);
    float* const moved[3] = {kDisplaced ? row_.u.x : row_.x.x, kDisplaced ? row_.u.y : row_.x.y,
                             kDisplaced ? row_.u.z : row_.x.z};
    for (int k = 0; k < 3; ++k) {
      const Wide change = e[k] * s;
      b.moved[k].far = b.moved[k].far + change;
      b.moved[k].near = b.moved[k].near - past(carried_[k], change, lanes);
      carried_[k] = change;
      b.moved[k].weave(moved[k] + a);
    }
    if constexpr (kMultipliers) b.lambda.weave(lambdas_ + a);
  }

  const ProjectRows& p_;
  const Alike& c_;
  const ProjectedRow row_;
  float* const lambdas_;
  Wide carried_[3]{};
};

// One colour along row j for any other offset.
template <Rule R>
WEFT_INLINE void along_row_alike(const ProjectRows& p, int j, int colour, const Alike& c) {
  constexpr bool kMultipliers = R == Rule::multipliers;
  const ProjectedRow near = projected_row(p, j, 0), far = projected_row(p, j, p.far);
  const std::int32_t* const lanes = p.lanes + std::ptrdiff_t(colour) * p.stride;
  float* const lambdas = p.lambda + std::ptrdiff_t(j) * p.stride;
  LongDelay3 delay(p.far);
  for (int a = 0; a < p.count + p.far; a += kLanes) {
    const WideInt active = lanes_at(lanes + a);
    const Wide3 e = position<displaced(R)>(far, a) - position<displaced(R)>(near, a);
    Wide lambda{}, before{};
    if constexpr (kMultipliers) lambda = before = load(lambdas + a);
    Wide scale;
    scales_alike<kMultipliers, 1>(c, &e, &lambda, &scale);
    scale = select(active, scale, Wide{});
    if constexpr (kMultipliers) store(lambdas + a, select(active, lambda, before));
    const Wide3 change = e * scale;
    shift<displaced(R)>(near, a, change - delay.next(change));
  }
}

// Row j of a family whose rows have one inverse mass and no torn constraints.
template <Rule R>
WEFT_INLINE void row_alike(const ProjectRows& p, int j, const Alike& c) {
  if (p.dj > 0) return BetweenRowsAlike<R>(p, j, c).run();
  if constexpr (kLanes > 1) {
    if (p.far == 1) return AlongRowAlike<R, 1>(p, j, c).run();
    if (p.far == 2) return AlongRowAlike<R, 2>(p, j, c).run();
  }
  for (int colour = 0; colour < 2; ++colour) along_row_alike<R>(p, j, colour, c);
}

// Whether any constraint of row j is longer than its rest length. Rows where none is, most of them,
// have nothing to do for the strain limit.
template <bool kTorn>
WEFT_INLINE bool any_too_long(const ProjectRows& p, int j) {
  const ProjectedRow near = projected_row(p, j, p.near), far = projected_row(p, j + p.dj, p.far);
  WideInt over{};
  for (int a = 0; a < p.count; a += kLanes) {
    const Wide3 e = load3(far.x, a) - load3(near.x, a);
    WideInt longer = dot(e, e) > p.rest * p.rest;
    if (a + kLanes > p.count) longer = longer & lanes_below(p.count - a);
    if constexpr (kTorn) longer = longer & alive_lanes(p, j, a);
    over = over | longer;
  }
  return any(over);
}

template <Rule R, bool kTorn>
void sweep_family(const ProjectRows& family, const physics::Projection& given) {
  const ProjectRows p = family;  // a copy that no store can alias
  const int end = given.end, colour = given.colour;
  Alike constants{};
  for (int j = given.begin; j < end; ++j) {
    if (p.dj > 0 && (j / p.dj % 2 != colour || j + p.dj >= p.rows)) continue;
    if constexpr (R == Rule::limit) {
      if (!any_too_long<kTorn>(p, j)) continue;
    } else if constexpr (!kTorn) {
      const float w = p.row_w ? p.row_w[j] : 0;
      if (w > 0 && w == p.row_w[j + p.dj]) {
        // A division is long to wait for, and mostly the row before has had the same.
        if (w != constants.w || compliance_at(p, j) != constants.compliance)
          constants = alike(p, j, w);
        row_alike<R>(p, j, constants);
        continue;
      }
    }
    if (p.dj > 0) {
      between_rows<R, kTorn>(p, j);
    } else {
      for (int c = 0; c < 2; ++c) along_row<R, kTorn>(p, j, c);
    }
  }
}

template <Rule R, bool kTorn>
void sweep(const physics::Projection& p) {
  for (int f = 0; f < p.count; ++f) sweep_family<R, kTorn>(p.families[f], p);
}

template <bool kTorn>
void sweep_by_rule(const physics::Projection& p) {
  const ProjectRows& f = p.families[0];
  if (f.limit) return sweep<Rule::limit, kTorn>(p);
  if (f.lambda) return sweep<Rule::multipliers, kTorn>(p);
  if (f.compliance) return sweep<Rule::compliant, kTorn>(p);
  sweep<Rule::rigid, kTorn>(p);
}

}  // namespace

void project(const physics::Projection& p) {
  if (p.families[0].alive) return sweep_by_rule<true>(p);
  sweep_by_rule<false>(p);
}

}  // namespace weft::WEFT_KERNELS
