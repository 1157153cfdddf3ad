// Stage "bending": the curvature energy (kernels/bending.cpp), as a force on the velocities before
// the springs of an explicit method, or as constraints before the sweeps of one that projects: all
// rows, then all columns, each line as a whole, then the twist of the cells in four colours.
#include <algorithm>

#include "physics/kernels/bending.h"
#include "physics/model/lattice/bending.h"
#include "physics/model/lattice/line_batches.h"
#include "physics/model/lattice/stages.h"
#include "physics/model/lattice/tearing.h"

namespace weft::physics {
namespace {

// Cost of one second difference and of one twist, for sizing tasks only.
constexpr double kDifferenceNs = 0.8, kTwistNs = 0.5;

std::int64_t terms(const Lattice& l) {
  const std::int64_t nx = l.columns, ny = l.rows;
  return std::max<std::int64_t>(nx - 2, 0) * ny + nx * std::max<std::int64_t>(ny - 2, 0) +
         (nx - 1) * (ny - 1);
}

// Which terms are left from lane `at` on; null: all.
const float* left(const LatticeParts& parts, AlignedArray<float> BendLinks::*terms,
                  std::size_t at) {
  const BendLinks* links = parts.tearing ? parts.tearing->bend_links() : nullptr;
  return links ? (links->*terms).data() + at : nullptr;
}

class BendingForce final : public RowStage {
 public:
  BendingForce(const LatticeParts& parts, std::shared_ptr<Remainders> left)
      : RowStage("bending", "curvature energy as a force", 2, terms(parts.lattice), "constraints"),
        parts_(parts),
        left_(std::move(left)) {
    const BendingStiffness k = bending_stiffness(parts.cloth);
    stiffness_ = {float(k.along), float(k.across), float(k.twist)};
  }

  void run(int j, const Substep& s) override {
    Lattice& l = parts_.lattice;
    BendRow r{};
    r.columns = l.columns;
    r.rows = std::min(3, l.rows - j);
    for (int n = 0; n < r.rows; ++n) {
      r.x[n] = l.x.row(j + n);
      r.v[n] = left_->kept ? left_->v.row(j + n) : l.v.row(j + n);
      r.w[n] = l.w(j + n);
    }
    r.k = stiffness_;
    r.k.along *= float(width_share(parts_.cloth, 0, j, 1, 0));
    r.width = l.column_width.data();
    const std::size_t at = std::size_t(j) * l.stride;
    r.along = left(parts_, &BendLinks::along, at);
    r.across = left(parts_, &BendLinks::across, at);
    r.twist = left(parts_, &BendLinks::twist, at);
    // The leapfrog step that follows takes drag off the velocity that it finds, but not off forces, nor off what is
    // left of earlier steps: what is added to that is not rounded to the velocity's last place.
    const double kept = left_->kept ? 1 : 1 - s.kick * parts_.cloth.drag;
    r.dt = float(kept > 0.01 ? s.kick / kept : s.kick);
    parts_.kernels.lattice.bend_row(r);
  }

 private:
  LatticeParts parts_;
  const std::shared_ptr<Remainders> left_;
  BendStiffness stiffness_;
};

class BendingConstraints final : public WholeStage {
 public:
  BendingConstraints(const LatticeParts& parts, Rows& corrections)
      : WholeStage("bending", "curvature energy, rows and columns each solved as a whole, twist",
                   terms(parts.lattice), "constraints"),
        parts_(parts),
        corrections_(corrections),
        damped_(parts.cloth.bending.damping > 0 ? Rows(parts.lattice.rows, parts.lattice.stride)
                                                : Rows()),
        x_(parts.cloth.bending.damping > 0 ? damped_ : parts.lattice.x),
        batches_(parts.lattice, x_, corrections, parts.kernels, kBendScratch) {
    if (parts.scene.solver.order == 2) batches_.follow_masses();
    if (left(parts, &BendLinks::along, 0))
      torn_ = TurnedLinks<float>(parts.lattice, batches_.row_groups());
  }

  std::size_t bytes() const override { return batches_.bytes() + torn_.bytes() + damped_.bytes(); }
  void restart() override {
    batches_.turn_masses();
    torn_.forget();
  }

  Velocities velocities() const override { return Velocities::left_alone; }
  void run(const Substep& s, Threads& threads) override {
    const BendingStiffness k = bending_stiffness(parts_.cloth);
    const double h = s.dt * implicit_share(parts_.scene.solver);
    const double rate = parts_.cloth.bending.damping / s.dt;
    const auto compliance = [&](double stiffness) {
      return float(1 / (stiffness * (1 + rate) * h * h));
    };
    if (s.dt != dt_) set_compliance(compliance(k.along), compliance(k.across), s.dt);
    batches_.begin(threads);
    if (rate > 0) take_off_start(float(rate / (1 + rate)), s.dt);
    along_rows();
    along_columns();
    twist(compliance(k.twist));
  }

 private:
  // Second differences D and twists are linear. Damping puts D + rate (D - D_before) = (1 + rate) (D - ρ D_before) in
  // their place, which is that of the places x - ρ x_before, ρ = rate/(1 + rate).
  void take_off_start(float share, double dt) {
    constexpr int kRowsTogether = 16;
    constexpr double kParticleNs = 0.5;
    Lattice& l = parts_.lattice;
    const SubstepStart start = start_of(parts_, dt);
    const auto take_off = [&](const float* x, const float* before, const float* v, float* to) {
      if (before)
        for (int i = 0; i < l.stride; ++i) to[i] = x[i] - share * before[i];
      else
        for (int i = 0; i < l.stride; ++i) to[i] = (1 - share) * x[i] + share * start.dt * v[i];
    };
    const auto row = [&](int j) {
      const ConstRow3 x = l.x.row(j);
      const auto in_row = [&](ConstRow3 r) { return r.x ? r.from(j * l.stride) : r; };
      const ConstRow3 before = in_row(start.previous), v = in_row(start.v);
      const Row3 to = damped_.row(j);
      take_off(x.x, before.x, v.x, to.x);
      take_off(x.y, before.y, v.y, to.y);
      take_off(x.z, before.z, v.z, to.z);
    };
    batches_.share_out((l.rows + kRowsTogether - 1) / kRowsTogether,
                       kParticleNs * kRowsTogether * l.columns, [&](int n, BatchMemory&) {
                         const int begin = n * kRowsTogether;
                         for (int j = begin; j < std::min(begin + kRowsTogether, l.rows); ++j)
                           row(j);
                       });
  }

  // Of every row and every column, where those on the border count half.
  void set_compliance(float along, float across, double dt) {
    dt_ = dt;
    const auto whole = [](int lines) { return std::size_t(lines + kBatchLines) & -kBatchLines; };
    rows_ = AlignedArray<float>(whole(parts_.lattice.rows));
    columns_ = AlignedArray<float>(whole(parts_.lattice.columns));
    std::fill_n(rows_.data(), rows_.size(), along);
    std::fill_n(columns_.data(), columns_.size(), across);
    for (int j = 0; j < parts_.lattice.rows; ++j)
      rows_[std::size_t(j)] /= float(width_share(parts_.cloth, 0, j, 1, 0));
    for (int i = 0; i < parts_.lattice.columns; ++i)
      columns_[std::size_t(i)] /= float(width_share(parts_.cloth, i, 0, 0, 1));
  }

  void along_rows() {
    const Lattice& l = parts_.lattice;
    batches_.share_out(batches_.row_groups(), kDifferenceNs * kBatchLines * l.columns,
                       [&](int group, BatchMemory& memory) {
                         const float* terms = left(parts_, &BendLinks::along, 0);
                         const float* turned =
                             terms ? torn_.follow(group, *parts_.tearing, terms) : nullptr;
                         batches_.turned(group, memory, [&](int rows) {
                           for (int first = 0; first < rows; first += kBendLines) {
                             const Row3 x = memory.tile.row(0), u = memory.corrections.row(0);
                             BendLine p{};
                             p.x = x.from(first);
                             p.u = u.from(first);
                             p.w = batches_.masses(group) + first;
                             p.step = kBatchLines;
                             p.particles = l.columns;
                             p.compliance = rows_.data() + group * kBatchLines + first;
                             if (turned) p.left = turned + first;
                             p.scratch = memory.scratch.data();
                             parts_.kernels.lattice.bend_line(p);
                           }
                         });
                       });
  }

  void along_columns() {
    Lattice& l = parts_.lattice;
    batches_.share_out((l.columns + kBendLines - 1) / kBendLines,
                       kDifferenceNs * kBendLines * l.rows, [&](int batch, BatchMemory& memory) {
                         const int first = batch * kBendLines;
                         BendLine p{};
                         p.x = x_.row(0).from(first);
                         p.u = corrections_.row(0).from(first);
                         p.w = l.w(0) + first;
                         p.step = l.stride;
                         p.particles = l.rows;
                         p.compliance = columns_.data() + first;
                         p.left = left(parts_, &BendLinks::across, std::size_t(first));
                         p.scratch = memory.scratch.data();
                         parts_.kernels.lattice.bend_line(p);
                       });
  }

  void twist(float compliance) {
    Lattice& l = parts_.lattice;
    for (int colour = 0; colour < 2; ++colour)
      batches_.share_out((l.rows - colour) / 2, kTwistNs * l.columns, [&](int pair, BatchMemory&) {
        const int j = 2 * pair + colour;
        TwistRow r{};
        r.columns = l.columns;
        r.x = x_.row(j);
        r.below = x_.row(j + 1);
        r.u = corrections_.row(j);
        r.u_below = corrections_.row(j + 1);
        r.w = l.w(j);
        r.w_below = l.w(j + 1);
        r.compliance = compliance;
        r.left = left(parts_, &BendLinks::twist, std::size_t(j) * l.stride);
        for (const bool odd : {false, true}) {
          r.odd = odd;
          parts_.kernels.lattice.bend_twist(r);
        }
      });
  }

  LatticeParts parts_;
  Rows& corrections_;
  Rows damped_;  // places less those before the substep, where bending is damped
  Rows& x_;      // these, or the lattice's
  LineBatches batches_;
  TurnedLinks<float> torn_;             // of the rows
  double dt_ = 0;                       // s, of the compliances
  AlignedArray<float> rows_, columns_;  // 1/kg, of the second differences along each
};

}  // namespace

std::unique_ptr<RowStage> make_bending_force(const LatticeParts& parts,
                                             std::shared_ptr<Remainders> left) {
  if (!parts.cloth.bending.given()) return nullptr;
  return std::make_unique<BendingForce>(parts, std::move(left));
}

std::unique_ptr<Stage> make_bending(const LatticeParts& parts, Rows& corrections) {
  if (!parts.cloth.bending.given()) return nullptr;
  return std::make_unique<BendingConstraints>(parts, corrections);
}

}  // namespace weft::physics
