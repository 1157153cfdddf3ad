// Stage "line": sweeps over the constraint families in which every line of a family (a row, column
// or diagonal; for offsets of n every n-th particle of one) is solved as a whole
// (kernels/line.cpp).
//
// Families are taken one after the other, what matters most last: diagonals, then columns, then
// rows, whose structural constraints are left exactly solved. (At 12 substeps a frame the greatest
// strain of a hanging sheet of 100 x 100 is 0.5 % in this order, 1.6 % with the diagonals last.)
// Lines of one family share no particle, so strips of them go to the threads in any order with the
// same result. A strip of columns is solved by all families along them while it is in the cache, and
// so are 32 rows, turned into lanes first and turned back at the end.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "physics/stages/stages.h"
#include "physics/stages/strips.h"

namespace weft::physics {
namespace {

// Cost of a constraint, for sizing tasks only.
constexpr double kConstraintNs = 0.9;

// Rigid lines between two pins have one constraint more than they have freedom; a compliance of
// this share of the inverse mass keeps their pivots away from zero.
constexpr double kLeastCompliance = 1e-5;

// What a family's lines need from one substep to the next.
struct LineFamily {
  const Family* family = nullptr;
  AlignedArray<float> compliance;  // [row][kStripLines], or one row where all are alike
  bool alike = true;
  AlignedArray<float> lambda;       // shaped like the lattice; families along rows: like the tiles
  TurnedLinks<std::int32_t> links;  // of families along rows that can tear

  int reach() const { return std::max(std::abs(family->di), family->dj); }
};

class Line final : public WholeStage {
 public:
  Line(const ClothParts& parts, const LineOptions& options)
      : WholeStage(
            "line",
            std::to_string(parts.families.size()) + " families, each line solved as a whole" +
                (options.iterations > 1 ? ", " + std::to_string(options.iterations) + " sweeps"
                                        : ""),
            parts.constraints() * options.iterations, "constraints"),
        parts_(parts),
        options_(options),
        strips_(parts.lattice, parts.kernels, kStripScratch) {
    for (const Family& f : parts.families) {
      LineFamily& l = (f.dj == 0   ? along_rows_
                       : f.di == 0 ? along_columns_
                                   : diagonal_)
                          .emplace_back();
      l.family = &f;
      l.alike = f.dj > 0 && parts.cloth.stiffness_gradient == 0;
      const int groups = strips_.row_groups();
      const int rows = l.alike ? 1 : f.dj == 0 ? groups : parts.lattice.rows;
      l.compliance = AlignedArray<float>(std::size_t(rows) * kStripLines);
      if (f.links && f.dj == 0) l.links = TurnedLinks<std::int32_t>(parts.lattice, groups);
      if (options.compliant && options.iterations > 1)
        l.lambda = AlignedArray<float>(
            f.dj == 0 ? std::size_t(groups) * kStripLines * parts.lattice.columns
                      : std::size_t(parts.lattice.rows) * parts.lattice.stride);
    }
    if (parts.scene.solver.order == 2) strips_.follow_masses();
    // Longest constraints first.
    for (auto* families : all())
      std::stable_sort(
          families->begin(), families->end(),
          [](const LineFamily& a, const LineFamily& b) { return a.reach() > b.reach(); });
    for (const float w : parts.lattice.inverse_mass.span()) least_ = std::max(least_, double(w));
    least_ *= kLeastCompliance;
  }

  std::size_t bytes() const override {
    std::size_t floats = 0;
    for (const auto* families : {&diagonal_, &along_columns_, &along_rows_})
      for (const LineFamily& l : *families)
        floats += l.compliance.size() + l.lambda.size() + l.links.bytes() / sizeof(float);
    return floats * sizeof(float) + strips_.bytes();
  }
  void restart() override {
    strips_.turn_masses();
    for (LineFamily& l : along_rows_) l.links.forget();
  }

  Velocities velocities(double dt) const override {
    return velocity_gain(parts_.scene.solver, options_.compliant, dt) == 0 ? Velocities::left_alone
                                                                           : Velocities::used;
  }
  void run(const Substep& s, Threads& threads) override {
    if (s.dt != dt_) set_compliance(s.dt);
    strips_.begin(threads);
    for (int n = 0; n < options_.iterations; ++n) sweep(n == 0);
  }

 private:
  std::array<std::vector<LineFamily>*, 3> all() {
    return {&diagonal_, &along_columns_, &along_rows_};
  }

  void sweep(bool fresh) {
    for (LineFamily& l : diagonal_) solve_strips({&l, 1}, fresh);
    if (!along_columns_.empty()) solve_strips(along_columns_, fresh);
    if (!along_rows_.empty()) solve_rows(fresh);
  }

  // All lines of families between rows, strip by strip: of several only where these are the same
  // particles.
  void solve_strips(std::span<LineFamily> families, bool fresh) {
    const Lattice& lattice = parts_.lattice;
    strips_.share_out((lattice.columns + kStripLines - 1) / kStripLines,
                      kConstraintNs * kStripLines * lattice.rows * double(families.size()),
                      [&](int strip, StripMemory& memory) {
                        for (LineFamily& l : families)
                          for (int start = 0; start < l.family->dj; ++start)
                            solve_strip(l, start, strip * kStripLines, fresh, memory);
                      });
  }

  // The lines that begin in row `start`, from line `first` on.
  void solve_strip(LineFamily& l, int start, int first, bool fresh, StripMemory& memory) {
    LineStrip p = between_rows(l, start);
    p.first = first;
    p.fresh = fresh;
    p.scratch = memory.scratch.data();
    parts_.kernels.line_strip(p);
  }

  LineStrip between_rows(LineFamily& l, int start) {
    Lattice& lattice = parts_.lattice;
    const Family& f = *l.family;
    LineStrip p{};
    p.x = lattice.x.row(start);
    p.v = lattice.v.row(start);
    p.inverse_dt = inverse_dt();
    p.w = lattice.w(start);
    p.step = std::ptrdiff_t(f.dj) * lattice.stride + f.di;
    p.particles = (lattice.rows - start + f.dj - 1) / f.dj;
    p.lean = f.di;
    p.columns = lattice.columns;
    p.rest = float(f.rest);
    p.share = options_.share;
    p.compliance = l.compliance.data() + (l.alike ? 0 : start * kStripLines);
    p.compliance_step = l.alike ? 0 : f.dj * kStripLines;
    if (l.lambda.size() > 0) p.lambda = l.lambda.data() + std::ptrdiff_t(start) * lattice.stride;
    if (f.links) p.alive = f.links->row(start) - f.near();
    return p;
  }

  void solve_rows(bool fresh) {
    strips_.share_out(
        strips_.row_groups(),
        kConstraintNs * kStripLines * parts_.lattice.columns * double(along_rows_.size()),
        [&](int group, StripMemory& memory) {
          strips_.turned(group, memory, inverse_dt(), [&](int rows, float gain) {
            solve_group(group, rows, gain, fresh, memory);
          });
        });
  }

  void solve_group(int group, int rows, float gain, bool fresh, StripMemory& memory) {
    const int columns = parts_.lattice.columns;
    for (LineFamily& l : along_rows_) {
      const int n = l.family->di;
      const std::int32_t* alive =
          l.family->links ? l.links.follow(group, *parts_.topology, l.family->links->row(0))
                          : nullptr;
      for (int start = 0; start < n; ++start) {
        LineStrip p{};
        p.x = memory.tile.row(start);
        p.v = memory.moved.row(start);
        p.inverse_dt = gain;
        p.w = strips_.masses(group) + start * kStripLines;
        p.step = n * kStripLines;
        p.particles = (columns - start + n - 1) / n;
        p.columns = rows;
        p.rest = float(l.family->rest);
        p.share = options_.share;
        p.compliance = l.compliance.data() + group * kStripLines;
        if (l.lambda.size() > 0)
          p.lambda = l.lambda.data() + (std::ptrdiff_t(group) * columns + start) * kStripLines;
        p.fresh = fresh;
        if (alive) p.alive = alive + start * kStripLines;
        p.scratch = memory.scratch.data();
        parts_.kernels.line_strip(p);
      }
    }
  }

  float inverse_dt() const { return velocity_gain(parts_.scene.solver, options_.compliant, dt_); }
  void set_compliance(double dt) {
    dt_ = dt;
    for (auto* families : all())
      for (LineFamily& l : *families)
        for (int j = 0; j < int(l.compliance.size()); ++j)
          l.compliance[j] = compliance(*l.family, l.family->dj == 0 ? j : j / kStripLines);
  }
  float compliance(const Family& f, int j) const {
    const double real = options_.compliant ? compliance_of(parts_, f, j, dt_) : 0;
    return float(std::max(real, least_));
  }

  ClothParts parts_;
  LineOptions options_;
  Strips strips_;
  double dt_ = 0;
  double least_ = 0;                                               // 1/kg
  std::vector<LineFamily> diagonal_, along_columns_, along_rows_;  // in the order of a sweep
};

}  // namespace

std::unique_ptr<Stage> make_line(const ClothParts& parts, const LineOptions& options) {
  if (parts.families.empty()) return nullptr;
  return std::make_unique<Line>(parts, options);
}

}  // namespace weft::physics
