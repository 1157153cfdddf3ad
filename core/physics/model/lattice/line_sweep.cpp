// Stage "line": sweeps over the constraint stencils in which every line of a stencil (a row, column
// or diagonal; for offsets of n every n-th particle of one) is solved as a whole
// (kernels/line.cpp).
//
// Stencils are taken one after the other, what matters most last: diagonals, then columns, then
// rows, whose structural constraints are left exactly solved. (At 12 substeps a frame the greatest
// strain of a hanging sheet of 100 x 100 is 0.5 % in this order, 1.6 % with the diagonals last.)
// Lines of one stencil share no particle, so batches of them go to the threads in any order with the
// same result. A batch of columns is solved by all stencils along them while it is in the cache, and
// so are 32 rows, turned into lanes first and turned back at the end.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "physics/model/lattice/membrane_lines.h"
#include "physics/model/lattice/stages.h"

namespace weft::physics {
namespace {

// Cost of a constraint, for sizing tasks only.
constexpr double kConstraintNs = 0.9;

// Rigid lines between two pins have one constraint more than they have freedom; a compliance of
// this share of the inverse mass keeps their pivots away from zero.
constexpr double kLeastCompliance = 1e-5;

// What a stencil's lines need from one substep to the next.
struct LineStencil {
  const Stencil* stencil = nullptr;
  // [row][width], or one row where all are alike. Columns have each their own where those at the sides
  // count half; else a batch is as wide as another.
  AlignedArray<float> compliance;
  bool alike = true;
  bool by_column = false;
  int width = kBatchLines;
  AlignedArray<float> lambda;       // shaped like the lattice; stencils along rows: like the tiles
  TurnedLinks<std::int32_t> links;  // of stencils along rows that can tear

  bool first = false;  // of a sweep, and between rows
  int reach() const { return std::max(std::abs(stencil->di), stencil->dj); }
};

class Line final : public WholeStage {
 public:
  Line(const LatticeParts& parts, Rows& corrections, const LineOptions& options)
      : WholeStage(
            "line",
            (options.membrane ? "rows, columns and diagonals of the membrane"
                              : std::to_string(parts.stencils.size()) + " stencils") +
                ", each line solved as a whole" +
                (options.iterations > 1 ? ", " + std::to_string(options.iterations) + " sweeps"
                                        : ""),
            parts.constraints() * options.iterations, "constraints"),
        parts_(parts),
        corrections_(corrections),
        options_(options),
        solve_(options.membrane ? parts.kernels.lines.membrane_line_batch
                                : parts.kernels.lines.line_batch),
        batches_(parts.lattice, parts.lattice.x, corrections, parts.kernels, kBatchScratch) {
    for (const Stencil& f : parts.stencils) {
      LineStencil& l = (f.dj == 0   ? along_rows_
                        : f.di == 0 ? along_columns_
                                    : diagonal_)
                           .emplace_back();
      l.stencil = &f;
      l.alike = f.dj > 0 && parts.cloth.stiffness_gradient == 0;
      const int groups = batches_.row_groups();
      const int rows = l.alike ? 1 : f.dj == 0 ? groups : parts.lattice.rows;
      l.by_column = f.di == 0 && (options.membrane || parts.lattice.column_width[0] < 1);
      if (l.by_column)
        l.width = (parts.lattice.columns + kBatchLines - 1) / kBatchLines * kBatchLines;
      l.compliance = AlignedArray<float>(std::size_t(rows) * l.width);
      if (f.links && f.dj == 0) l.links = TurnedLinks<std::int32_t>(parts.lattice, groups);
      if (options.compliant && options.iterations > 1)
        l.lambda = AlignedArray<float>(
            f.dj == 0 ? std::size_t(groups) * kBatchLines * parts.lattice.columns
                      : std::size_t(parts.lattice.rows) * parts.lattice.stride);
    }
    if (options.tears && !options.compliant)
      before_ = Rows(parts.lattice.rows, parts.lattice.stride);
    if (options.membrane) membrane_ = std::make_unique<MembraneLines>(parts);
    if (parts.scene.solver.order == 2) batches_.follow_masses();
    // Longest constraints first.
    for (auto* stencils : all())
      std::stable_sort(
          stencils->begin(), stencils->end(),
          [](const LineStencil& a, const LineStencil& b) { return a.reach() > b.reach(); });
    if (auto& between = diagonal_.empty() ? along_columns_ : diagonal_; !between.empty())
      between.front().first = true;
    for (const float w : parts.lattice.inverse_mass.span()) least_ = std::max(least_, double(w));
    least_ *= kLeastCompliance;
  }

  std::size_t bytes() const override {
    std::size_t floats = 0;
    for (const auto* stencils : {&diagonal_, &along_columns_, &along_rows_})
      for (const LineStencil& l : *stencils)
        floats += l.compliance.size() + l.lambda.size() + l.links.bytes() / sizeof(float);
    return floats * sizeof(float) + before_.bytes() + batches_.bytes() +
           (membrane_ ? membrane_->bytes() : 0);
  }
  void restart() override {
    batches_.turn_masses();
    for (LineStencil& l : along_rows_) l.links.forget();
  }

  Velocities velocities() const override { return Velocities::left_alone; }
  void run(const Substep& s, Threads& threads) override {
    if (s.dt != dt_) set_compliance(s.dt);
    batches_.begin(threads);
    for (int n = 0; n < options_.iterations; ++n)
      sweep(n == 0, options_.tears && n + 1 == options_.iterations);
  }

 private:
  std::array<std::vector<LineStencil>*, 3> all() {
    return {&diagonal_, &along_columns_, &along_rows_};
  }

  void sweep(bool fresh, bool tears) {
    const bool zero = fresh && options_.corrections_zero;
    if (membrane_) membrane_->look(batches_, zero ? nullptr : &corrections_);
    const auto solve = [&](std::span<LineStencil> lines) {
      if (lines.empty()) return;
      if (tears && !options_.compliant) before_.copy(corrections_);
      lines[0].stencil->dj > 0 ? solve_batches(lines, fresh) : solve_rows(fresh);
      if (tears) end_overlong(lines);
    };
    for (LineStencil& l : diagonal_) solve({&l, 1});
    solve(along_columns_);
    solve(along_rows_);
  }

  // Ends constraints past their tear length, each as long as its own line's solution leaves it: as its force, which is
  // in balance along the line, stretches it. Others move it again. Rigid lines have no such length: there it is the
  // mean of before and after, as constraint by constraint (gauss_seidel.cpp).
  void end_overlong(std::span<const LineStencil> lines) {
    Lattice& lattice = parts_.lattice;
    const auto end_in = [&](int j) {
      for (const LineStencil& l : lines) {
        const Stencil& f = *l.stencil;
        if (j + f.dj >= lattice.rows) continue;
        const TearEnds after = ends_of(f, corrections_, j);
        const TearEnds moved[2] = {options_.compliant ? after : ends_of(f, before_, j), after};
        parts_.ended[j] +=
            parts_.kernels.lattice.tear({f.per_row(lattice.columns), ends_of(f, lattice.x, j),
                                         moved, f.links->row(j), tear_length(parts_.cloth, f)});
      }
    };
    batches_.share_out(batches_.row_groups(),
                       kConstraintNs * kBatchLines * lattice.columns * double(lines.size()),
                       [&](int group, BatchMemory&) {
                         const int begin = group * kBatchLines;
                         for (int j = begin; j < std::min(begin + kBatchLines, lattice.rows); ++j)
                           end_in(j);
                       });
  }

  // All lines of stencils between rows, batch by batch: of several only where these are the same
  // particles.
  void solve_batches(std::span<LineStencil> stencils, bool fresh) {
    const Lattice& lattice = parts_.lattice;
    batches_.share_out((lattice.columns + kBatchLines - 1) / kBatchLines,
                       kConstraintNs * kBatchLines * lattice.rows * double(stencils.size()),
                       [&](int batch, BatchMemory& memory) {
                         for (LineStencil& l : stencils)
                           for (int start = 0; start < l.stencil->dj; ++start)
                             solve_batch(l, start, batch * kBatchLines, fresh, memory);
                       });
  }

  // The lines that begin in row `start`, from line `first` on.
  void solve_batch(LineStencil& l, int start, int first, bool fresh, BatchMemory& memory) {
    LineBatch p = between_rows(l, start, fresh);
    p.first = first;
    if (l.by_column) p.compliance += first;
    p.fresh = fresh;
    p.scratch = memory.scratch.data();
    solve_(p);
  }

  LineBatch between_rows(LineStencil& l, int start, bool fresh) {
    Lattice& lattice = parts_.lattice;
    const Stencil& f = *l.stencil;
    LineBatch p{};
    p.x = lattice.x.row(start);
    p.u = corrections_.row(start);
    p.first_corrections = fresh && options_.corrections_zero && l.first;
    p.w = lattice.w(start);
    p.step = std::ptrdiff_t(f.dj) * lattice.stride + f.di;
    p.particles = (lattice.rows - start + f.dj - 1) / f.dj;
    p.lean = f.di;
    p.columns = lattice.columns;
    p.rest = float(f.rest);
    p.share = options_.share;
    p.compliance = l.compliance.data() + (l.alike ? 0 : std::ptrdiff_t(start) * l.width);
    p.compliance_step = l.alike ? 0 : std::ptrdiff_t(f.dj) * l.width;
    if (l.lambda.size() > 0) p.lambda = l.lambda.data() + std::ptrdiff_t(start) * lattice.stride;
    if (f.links) p.alive = f.links->row(start) - f.near();
    if (!membrane_) return p;
    p.squares = membrane_->squares(f, start);
    p.steps = MembraneLines::steps(f);
    const std::int32_t* sheared = membrane_->sheared(start);
    if (sheared && f.kind == Kind::shear) p.alive = sheared - f.near();
    return p;
  }

  void solve_rows(bool fresh) {
    batches_.share_out(
        batches_.row_groups(),
        kConstraintNs * kBatchLines * parts_.lattice.columns * double(along_rows_.size()),
        [&](int group, BatchMemory& memory) {
          batches_.turned(group, memory,
                          [&](int rows) { solve_group(group, rows, fresh, memory); });
        });
  }

  void solve_group(int group, int rows, bool fresh, BatchMemory& memory) {
    const int columns = parts_.lattice.columns;
    const float* squares = membrane_ ? membrane_->turned(group, batches_) : nullptr;
    for (LineStencil& l : along_rows_) {
      const int n = l.stencil->di;
      const std::int32_t* alive =
          l.stencil->links ? l.links.follow(group, *parts_.tearing, l.stencil->links->row(0))
                           : nullptr;
      for (int start = 0; start < n; ++start) {
        LineBatch p{};
        p.x = memory.tile.row(start);
        p.u = memory.corrections.row(start);
        p.first_corrections = &l == &along_rows_.front();
        p.w = batches_.masses(group) + start * kBatchLines;
        p.step = n * kBatchLines;
        p.particles = (columns - start + n - 1) / n;
        p.columns = rows;
        p.rest = float(l.stencil->rest);
        p.squares = squares;
        p.steps = MembraneLines::steps(*l.stencil);
        p.share = options_.share;
        p.compliance = l.compliance.data() + group * kBatchLines;
        if (l.lambda.size() > 0)
          p.lambda = l.lambda.data() + (std::ptrdiff_t(group) * columns + start) * kBatchLines;
        p.fresh = fresh;
        if (alive) p.alive = alive + start * kBatchLines;
        p.scratch = memory.scratch.data();
        solve_(p);
      }
    }
  }

  void set_compliance(double dt) {
    dt_ = dt;
    if (membrane_) membrane_->prepare(dt);
    for (auto* stencils : all())
      for (LineStencil& l : *stencils)
        for (int n = 0; n < int(l.compliance.size()); ++n)
          l.compliance[n] = l.stencil->dj == 0
                                ? compliance(*l.stencil, n, 1)
                                : compliance(*l.stencil, n / l.width, column_width(l, n % l.width));
  }
  float column_width(const LineStencil& l, int column) const {
    if (!l.by_column || column >= parts_.lattice.columns) return 1;
    const bool side = column == 0 || column == parts_.lattice.columns - 1;
    if (membrane_) return side ? 0.5f : 1.0f;
    return parts_.lattice.column_width[std::size_t(column)];
  }
  float compliance(const Stencil& f, int j, float width) const {
    if (membrane_)
      return float(std::max(membrane_->compliance(f, std::min(j, parts_.lattice.rows - 1), width),
                            least_ * f.rest * f.rest));
    const double real = options_.compliant ? compliance_of(parts_, f, j, dt_) / width : 0;
    return float(std::max(real, least_));
  }

  LatticeParts parts_;
  Rows& corrections_;
  Rows before_;  // corrections before the last lines, where rigid ones may tear
  LineOptions options_;
  void (*solve_)(const LineBatch&);
  LineBatches batches_;
  std::unique_ptr<MembraneLines> membrane_;
  double dt_ = 0;
  double least_ = 0;                                                // 1/kg
  std::vector<LineStencil> diagonal_, along_columns_, along_rows_;  // in the order of a sweep
};

}  // namespace

std::unique_ptr<Stage> make_line(const LatticeParts& parts, Rows& corrections,
                                 const LineOptions& options) {
  if (parts.stencils.empty()) return nullptr;
  return std::make_unique<Line>(parts, corrections, options);
}

}  // namespace weft::physics
