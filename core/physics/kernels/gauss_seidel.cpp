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
    float* const v = p.v.x + (r.x + i - p.x.x);
    store_planes(v, r.plane, load_planes(v, r.plane) + change * wide(p.inverse_dt));
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

// The same between rows whose particles all have the inverse mass of c, of one column or, as kNear and
// kFar say, from lane a+1 to a or a to a+1. Ends are loaded and stored in whole blocks, and their lanes
// shifted: a load has at hand what was stored a moment ago only if it wants those very bytes.
template <Rule R, int kNear, int kFar>
class BetweenRowsAlike {
 public:
  // For other offsets than 0 and 1, the ends lie `near` and `far` lanes on.
  WEFT_INLINE BetweenRowsAlike(const ProjectRows& p, int j, const Alike& c, int near, int far)
      : count_(p.count),
        c_(c),
        near_(projected_row(p, j, near)),
        far_(projected_row(p, j + p.dj, far)),
        lambdas_(p.lambda + std::ptrdiff_t(j) * p.stride) {}

  WEFT_INLINE void run() {
    const int end = count_ + (kNear | kFar);
    if constexpr (kShifted) next_ = position<kDisplaced>(kNear ? near_ : far_, 0);
    for (int a = 0; a < end; a += kLanes) block(a, end);
  }

 private:
  static constexpr bool kMultipliers = R == Rule::multipliers, kDisplaced = displaced(R);
  static constexpr bool kShifted = kNear + kFar > 0;

  WEFT_INLINE Wide3 edge(int a, int end) {
    if constexpr (kShifted) {
      const Wide3 b = next_;
      if (a + kLanes < end) next_ = position<kDisplaced>(kNear ? near_ : far_, a + kLanes);
      const Wide3 shifted{following<1>(b.x, next_.x), following<1>(b.y, next_.y),
                          following<1>(b.z, next_.z)};
      const Wide3 other = position<kDisplaced>(kNear ? far_ : near_, a);
      return kNear ? other - shifted : shifted - other;
    }
    return position<kDisplaced>(far_, a) - position<kDisplaced>(near_, a);
  }

  WEFT_INLINE void block(int a, int end) {
    const Wide3 e = edge(a, end);
    Wide lambda{};
    if constexpr (kMultipliers) lambda = load(lambdas_ + a);
    const Wide before = lambda;
    Wide scale = scale_alike<kMultipliers>(c_, e, lambda);
    if (a + kLanes > count_) {
      const WideInt active = lanes_below(count_ - a);
      scale = select(active, scale, Wide{});
      lambda = select(active, lambda, before);
    }
    if constexpr (kMultipliers) store(lambdas_ + a, lambda);
    Wide3 past_e;
    Wide past_scale;
    if constexpr (kShifted) {
      past_e = edges_.next(e);
      past_scale = scales_.next(scale);
    }
    float* const near = movable<kDisplaced>(near_) + a;
    float* const far = movable<kDisplaced>(far_) + a;
    const std::ptrdiff_t plane = near_.plane;
    store_planes(near, plane,
                 fma(kNear ? past_e : e, kNear ? past_scale : scale, load_planes(near, plane)));
    store_planes(far, plane,
                 fnma(kFar ? past_e : e, kFar ? past_scale : scale, load_planes(far, plane)));
  }

  const int count_;
  const Alike& c_;
  const ProjectedRow near_, far_;
  float* const lambdas_;
  Wide3 next_;  // positions of the shifted ends' next block
  Delay3<1> edges_;
  Delay<1> scales_;
};

// Both colours along row j, N lanes from end to end. Two blocks at a time take their first colour;
// the second, which reaches into the next two blocks, follows behind. The two blocks are neighbours in
// the row, or, with kRows, of the same lanes in rows j and j+1: which leaves fewer lanes idle.
template <Rule R, int N, bool kRows>
class AlongRowAlike {
 public:
  WEFT_INLINE AlongRowAlike(const ProjectRows& p, int j, const Alike& c)
      : c_(c),
        count_(p.count),
        row_(projected_row(p, j, 0)),
        lambdas_(p.lambda + std::ptrdiff_t(j) * p.stride),
        apart_(kRows ? p.stride : kNext) {}

  // Two pairs of blocks behind, so that neither colour waits for the other's roots.
  WEFT_INLINE void run() {
    for (int first = 0; first < kChains; ++first) {
      for (Wide& c : carried_) c = Wide{};
      run_from(first, count_ + N);
    }
  }

 private:
  // Lane by lane, a row is N chains whose links are N lanes long.
  static constexpr int kChains = kLanes == 1 ? N : 1, kNext = kLanes == 1 ? N : kLanes;
  static constexpr int kStep = kRows ? kLanes : 2 * kNext;    // lanes from pair to pair
  static constexpr int kGroup = kRows ? kLanes / 2 : kLanes;  // ends of one row
  static constexpr bool kMultipliers = R == Rule::multipliers, kDisplaced = displaced(R);

  // Two blocks, parted: where their first colour has put them, and by how much it has moved them.
  struct Blocks {
    Parting<N> at[3];
    Wide change[3];
    Parting<N> lambda;
  };

  WEFT_INLINE void run_from(int a, int end) {
    Blocks last = first_colour(a), before{};
    a += kStep;
    if (a < end) {
      before = last;
      last = first_colour(a);
      for (a += kStep; a < end; a += kStep) {
        const Blocks now = first_colour(a);
        second_colour(before, last, a - 2 * kStep);
        before = last;
        last = now;
      }
      second_colour(before, last, a - 2 * kStep);
    }
    second_colour(last, Blocks{}, a - kStep);
  }

  WEFT_INLINE Parting<N> lambdas(int a) const {
    return {load(lambdas_ + a), load(lambdas_ + a + apart_)};
  }

  // What scales the edges e of one colour. In its row, the constraint of lane 0 has number a.
  WEFT_INLINE Wide scale(Wide3 e, Wide& lambda, int a) const {
    const Wide before = lambda;
    Wide s = scale_alike<kMultipliers>(c_, e, lambda);
    if (a + kStep > count_) {
      const WideInt l = lane_numbers() % kGroup;
      const WideInt active = l / N * (2 * N) + l % N < count_ - a;
      s = select(active, s, Wide{});
      lambda = select(active, lambda, before);
    }
    return s;
  }

  WEFT_INLINE Blocks first_colour(int a) const {
    Blocks b;
    const Wide3 one = position<kDisplaced>(row_, a), two = position<kDisplaced>(row_, a + apart_);
    b.at[0] = {one.x, two.x};
    b.at[1] = {one.y, two.y};
    b.at[2] = {one.z, two.z};
    if constexpr (kMultipliers) b.lambda = lambdas(a);
    Wide e[3];
    for (int k = 0; k < 3; ++k) e[k] = b.at[k].far - b.at[k].near;
    const Wide s = scale({e[0], e[1], e[2]}, b.lambda.near, a);
    for (int k = 0; k < 3; ++k) {
      b.change[k] = e[k] * s;
      b.at[k].near = b.at[k].near + b.change[k];
      b.at[k].far = b.at[k].far - b.change[k];
    }
    return b;
  }

  // From the far ends of b, whose first lane is a, to the near ends that follow; stores b.
  WEFT_INLINE void second_colour(const Blocks& b, const Blocks& after, int a) {
    Wide e[3];
    for (int k = 0; k < 3; ++k)
      e[k] = following<N, kGroup>(b.at[k].near, after.at[k].near) - b.at[k].far;
    Parting<N> lambda = b.lambda;
    const Wide s = scale({e[0], e[1], e[2]}, lambda.far, a + N);
    for (int k = 0; k < 3; ++k) {
      const Wide change = e[k] * s, back = preceding<N, kGroup>(carried_[k], change);
      carried_[k] = change;
      Parting<N> moved;
      moved.near = (kDisplaced ? b.change[k] : b.at[k].near) - back;
      moved.far = kDisplaced ? change - b.change[k] : b.at[k].far + change;
      float* const at = movable<kDisplaced>(row_) + k * row_.plane + a;
      Wide first = moved.first(), second = moved.second();
      if constexpr (kDisplaced) {
        first = load(at) + first;
        second = load(at + apart_) + second;
      }
      store(at, first);
      store(at + apart_, second);
    }
    if constexpr (kMultipliers) {
      store(lambdas_ + a, lambda.first());
      store(lambdas_ + a + apart_, lambda.second());
    }
  }

  const Alike& c_;
  const int count_;
  const ProjectedRow row_;
  float* const lambdas_;
  const std::ptrdiff_t apart_;  // floats from the first to the second block
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
    const Wide scale = select(active, scale_alike<kMultipliers>(c, e, lambda), Wide{});
    if constexpr (kMultipliers) store(lambdas + a, select(active, lambda, before));
    const Wide3 change = e * scale;
    shift<displaced(R)>(near, a, change - delay.next(change));
  }
}

// Row j of a family whose rows have one inverse mass and no torn constraints.
template <Rule R>
WEFT_INLINE void row_alike(const ProjectRows& p, int j, const Alike& c) {
  if (p.dj > 0) {
    if (p.near == 1) return BetweenRowsAlike<R, 1, 0>(p, j, c, 0, 0).run();
    if (p.far == 1) return BetweenRowsAlike<R, 0, 1>(p, j, c, 0, 0).run();
    return BetweenRowsAlike<R, 0, 0>(p, j, c, p.near, p.far).run();
  }
  if (p.far == 1) return AlongRowAlike<R, 1, false>(p, j, c).run();
  if (p.far == 2) return AlongRowAlike<R, 2, false>(p, j, c).run();
  for (int colour = 0; colour < 2; ++colour) along_row_alike<R>(p, j, colour, c);
}

// Rows j and j+1 at once of a family along rows, where that is possible.
template <Rule R>
WEFT_INLINE bool two_rows_alike(const ProjectRows& p, int j, const Alike& c) {
  if (kLanes == 1 || p.dj > 0 || p.far > 2) return false;
  if (p.row_w[j + 1] != c.w || compliance_at(p, j + 1) != c.compliance) return false;
  if constexpr (kLanes > 1) {
    if (p.far == 1)
      AlongRowAlike<R, 1, true>(p, j, c).run();
    else
      AlongRowAlike<R, 2, true>(p, j, c).run();
  }
  return true;
}

// Whether any constraint of row j is longer than its rest length. Rows where none is, most of them,
// have nothing to do for the strain limit.
template <bool kTorn>
WEFT_INLINE bool any_too_long(const ProjectRows& p, int j) {
  const ProjectedRow near = projected_row(p, j, p.near), far = projected_row(p, j + p.dj, p.far);
  WideInt over{};
  for (int a = 0; a < p.count; a += kLanes) {
    const Wide3 e = position<false>(far, a) - position<false>(near, a);
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
        if (j + 1 < end && two_rows_alike<R>(p, j, constants))
          ++j;
        else
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
