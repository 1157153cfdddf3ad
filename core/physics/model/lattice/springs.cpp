// Stage "springs": all spring forces on a cloth and its leapfrog step, in one pass over the rows.
// Every spring is evaluated once, in the row of its near end; what it exerts on later rows is
// carried along, so that a row is finished, and moved in place, as soon as its own springs are done.
#include "physics/model/lattice/plain_rows.h"

namespace weft::physics {
namespace {

constexpr int kGuard = 16;  // zero lanes that a stencil's kernel reads before a row

// Rounding of a reciprocal length must not hide that the length is too long.
constexpr float kAlmost = 1 + 1e-6f;

// The six stencils of a plain cloth in one kernel.
class PlainSprings final : public PlainLeapfrogStage {
 public:
  PlainSprings(const LatticeParts& parts, bool damped, std::shared_ptr<Remainders> left)
      : PlainLeapfrogStage("springs",
                           std::string("structural, shear and bend springs") +
                               (damped ? " with damping" : "") + ", leapfrog step",
                           parts, std::move(left)),
        damped_(damped),
        springs_(std::size_t(parts.lattice.rows) * kPlainStencils) {
    for (int j = 0; j < parts.lattice.rows; ++j)
      for (int f = 0; f < kPlainStencils; ++f) {
        const Stencil& stencil = parts.stencils[f];
        SpringConstants& c = springs_[std::size_t(j) * kPlainStencils + f];
        c = spring_constants(parts.cloth, stencil, j);
        if (parts.overlong) c.taut = kAlmost / tear_length(parts.cloth, stencil);
      }
  }
  std::size_t bytes() const override {
    return PlainLeapfrogStage::bytes() + springs_.size() * sizeof(SpringConstants);
  }
  void run(int begin, int end, const Substep& s) override {
    SpringRows r{};
    r.constants = springs_.data();
    r.damped = damped_;
    r.overlong = parts_.overlong;
    if (r.overlong) std::fill(r.overlong + begin, r.overlong + end, std::uint8_t{0});
    for_alike(r, begin, end, s, parts_.kernels.lattice.spring_rows);
  }

 private:
  bool damped_;
  std::vector<SpringConstants> springs_;
};

// Any stencils, one kernel call each: levels, subsets.
class StencilSprings final : public Leapfrog<RowStage> {
 public:
  StencilSprings(const LatticeParts& parts, int reach, bool damped,
                 std::shared_ptr<Remainders> left)
      : Leapfrog(parts, std::move(left), "springs",
                 std::to_string(parts.stencils.size()) + " spring stencils" +
                     (damped ? " with damping" : "") + ", leapfrog step",
                 reach, parts.constraints(), "constraints"),
        parts_(parts),
        kernel_(damped ? parts.kernels.lattice.damped_spring_stencil
                       : parts.kernels.lattice.spring_stencil) {}

  void reserve_slots(int slots) override {
    force_ = Rows((reach + 1) * slots, parts_.lattice.stride);
    scratch_ = AlignedArray<float>(kGuard + std::size_t(slots) * 3 * parts_.lattice.stride);
  }
  std::size_t bytes() const override {
    return Leapfrog::bytes() + force_.bytes() + scratch_.size() * sizeof(float);
  }

  void start(const Substep& s) override {
    for (int k = 0; k <= reach; ++k)
      zero(force_.row(s.slot * (reach + 1) + k), parts_.lattice.stride);
  }

  void run(int j, const Substep& s) override {
    Lattice& l = parts_.lattice;
    const auto force = [&](int row) {
      return force_.row(s.slot * (reach + 1) + row % (reach + 1));
    };
    for (const Stencil& stencil : parts_.stencils) {
      if (j + stencil.dj >= l.rows) continue;
      StencilRow r = stencil_row(l, stencil, j);
      r.f = force(j);
      r.f_far = force(j + stencil.dj);
      r.scratch = scratch_.data() + kGuard + std::size_t(s.slot) * 3 * l.stride;
      r.stride = l.stride;
      r.spring = spring_constants(parts_.cloth, stencil, j);
      kernel_(r);
    }
    AdvanceRow a{};
    a.columns = l.columns;
    a.x = l.x.row(j);
    a.v = l.v.row(j);
    a.w = l.w(j);
    a.f = force(j);
    a.advance = advance_of(parts_, s);
    a.left = left_->row(j);
    parts_.kernels.particles.integrate(a);
  }

 private:
  LatticeParts parts_;
  void (*kernel_)(const StencilRow&);
  Rows force_;  // reach+1 rows in turn per slot: row j's is complete when row j is moved
  AlignedArray<float> scratch_;
};

}  // namespace

std::int64_t LatticeParts::constraints() const {
  std::int64_t n = 0;
  for (const Stencil& f : stencils)
    n += std::int64_t(f.per_row(lattice.columns)) * (lattice.rows - f.dj);
  return n;
}

int greatest_reach(const LatticeParts& parts) {
  int reach = 0;
  for (const Stencil& f : parts.stencils) reach = std::max(reach, f.dj);
  return reach;
}

std::unique_ptr<RowStage> make_springs(const LatticeParts& parts, bool damped,
                                       std::shared_ptr<Remainders> left) {
  if (is_plain(parts)) return std::make_unique<PlainSprings>(parts, damped, std::move(left));
  return std::make_unique<StencilSprings>(parts, greatest_reach(parts), damped, std::move(left));
}

}  // namespace weft::physics
