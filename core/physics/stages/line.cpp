// Stage "line": sweeps over the constraint families in which every line of a family (a row, column
// or diagonal; for offsets of n every n-th particle of one) is solved as a whole (kernels/line.cpp).
//
// Families are taken one after the other; lines of one family share no particle, so strips of them
// go to the threads in any order with the same result. Rows are turned into lanes first, 32 at a
// time, and all families along the rows are solved on them before they are turned back.
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "physics/kernels/line.h"
#include "physics/stages/stages.h"
#include "physics/threads.h"

namespace weft::physics {
namespace {

// The least work worth a task, in constraints.
constexpr std::int64_t kTaskConstraints = 16384;

// Rigid lines between two pins have one constraint more than they have freedom; a compliance of
// this share of the inverse mass keeps their pivots away from zero.
constexpr double kLeastCompliance = 1e-5;

// The memory of one thread.
struct Bench {
  AlignedArray<float> scratch;
  Rows tile;              // 32 rows as lanes: [column][kStripLines] of x, y, z
  AlignedArray<float> w;  // and of the inverse masses
};

// What a family's lines need from one substep to the next.
struct LineFamily {
  const Family* family = nullptr;
  AlignedArray<float> compliance;  // [row][kStripLines], or one row where all are alike
  bool alike = true;
  AlignedArray<float> lambda;  // shaped like the lattice; families along rows: like the tiles
};

class Line final : public WholeStage {
 public:
  Line(const ClothParts& parts, const LineOptions& options)
      : WholeStage("line",
                   std::to_string(parts.families.size()) + " families, each line solved as a whole" +
                       (options.iterations > 1
                            ? ", " + std::to_string(options.iterations) + " sweeps"
                            : ""),
                   parts.constraints() * options.iterations, "constraints"),
        parts_(parts),
        options_(options) {
    for (const Family& f : parts.families) {
      LineFamily& l = (f.dj == 0 ? along_rows_ : between_rows_).emplace_back();
      l.family = &f;
      l.alike = f.dj > 0 && parts.cloth.stiffness_gradient == 0;
      const int groups = (parts.lattice.rows + kStripLines - 1) / kStripLines;
      const int rows = l.alike ? 1 : f.dj == 0 ? groups : parts.lattice.rows;
      l.compliance = AlignedArray<float>(std::size_t(rows) * kStripLines);
      if (options.compliant && options.iterations > 1)
        l.lambda = AlignedArray<float>(
            f.dj == 0 ? std::size_t(groups) * kStripLines * parts.lattice.columns
                      : std::size_t(parts.lattice.rows) * parts.lattice.stride);
    }
    for (const float w : parts.lattice.inverse_mass.span()) least_ = std::max(least_, double(w));
    least_ *= kLeastCompliance;
  }

  std::size_t bytes() const override {
    std::size_t floats = 0, tiles = 0;
    for (const auto* families : {&along_rows_, &between_rows_})
      for (const LineFamily& l : *families) floats += l.compliance.size() + l.lambda.size();
    for (const Bench& b : benches_) {
      floats += b.scratch.size() + b.w.size();
      tiles += b.tile.bytes();
    }
    return floats * sizeof(float) + tiles;
  }

  void run(const Substep& s, Threads& threads) override {
    if (s.dt != dt_) set_compliance(s.dt);
    while (int(benches_.size()) < threads.count()) benches_.push_back(make_bench());
    threads.run([&] {
      for (int n = 0; n < options_.iterations; ++n) sweep(n == 0, threads.count());
    });
  }

 private:
  void sweep(bool fresh, int threads) {
    if (!along_rows_.empty()) {
      const int groups = (parts_.lattice.rows + kStripLines - 1) / kStripLines;
      share_out(groups, std::int64_t(parts_.lattice.columns) * kStripLines, threads,
                [&](int group, Bench& bench) { solve_rows(group, fresh, bench); });
    }
    for (LineFamily& l : between_rows_) {
      const Family& f = *l.family;
      for (int start = 0; start < f.dj; ++start) {
        const int particles = (parts_.lattice.rows - start + f.dj - 1) / f.dj;
        const int leaning = (particles - 1) * std::abs(f.di);
        const int lines = parts_.lattice.columns + leaning;
        const int first = f.di > 0 ? -leaning : 0;
        const int strips = (lines + kStripLines - 1) / kStripLines;
        const std::int64_t work = std::int64_t(particles) * parts_.lattice.columns / strips;
        share_out(strips, work, threads, [&](int strip, Bench& bench) {
          LineStrip p = between_rows(l, start, particles, fresh, bench);
          p.first = first + strip * kStripLines;
          p.lines = lines - strip * kStripLines <= 16 ? 16 : kStripLines;
          parts_.kernels.line_strip(p);
        });
      }
    }
  }

  // Calls solve(n, bench) for n = 0 … count-1, each worth `constraints`.
  template <class Solve>
  void share_out(int count, std::int64_t constraints, int threads, const Solve& solve) {
    const std::int64_t grain = std::max<std::int64_t>(1, kTaskConstraints / std::max<std::int64_t>(constraints, 1));
    if (threads == 1 || grain >= count) {
      for (int n = 0; n < count; ++n) solve(n, benches_[0]);
      return;
    }
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<int>(0, count, std::size_t(grain)),
        [&](const oneapi::tbb::blocked_range<int>& some) {
          Bench& bench = benches_[std::size_t(oneapi::tbb::this_task_arena::current_thread_index())];
          for (int n = some.begin(); n < some.end(); ++n) solve(n, bench);
        },
        oneapi::tbb::simple_partitioner{});
  }

  LineStrip between_rows(LineFamily& l, int start, int particles, bool fresh, Bench& bench) {
    Lattice& lattice = parts_.lattice;
    const Family& f = *l.family;
    LineStrip p{};
    p.x = lattice.x.row(start);
    p.w = lattice.w(start);
    p.step = std::ptrdiff_t(f.dj) * lattice.stride + f.di;
    p.particles = particles;
    p.lean = f.di;
    p.columns = lattice.columns;
    p.rest = float(f.rest);
    p.share = options_.share;
    p.compliance = l.compliance.data() + (l.alike ? 0 : start * kStripLines);
    p.compliance_step = l.alike ? 0 : f.dj * kStripLines;
    p.lambda = l.lambda.size() > 0 ? l.lambda.data() + std::ptrdiff_t(start) * lattice.stride : nullptr;
    p.fresh = fresh;
    p.scratch = bench.scratch.data();
    return p;
  }

  void solve_rows(int group, bool fresh, Bench& bench) {
    Lattice& lattice = parts_.lattice;
    const int begin = group * kStripLines;
    const int rows = std::min(kStripLines, lattice.rows - begin);
    turn(begin, rows, bench, parts_.kernels.rows_to_lanes, true);
    for (LineFamily& l : along_rows_) {
      const int n = l.family->di;
      for (int start = 0; start < n; ++start) {
        LineStrip p{};
        p.x = bench.tile.row(start);
        p.w = bench.w.data() + start * kStripLines;
        p.step = n * kStripLines;
        p.particles = (lattice.columns - start + n - 1) / n;
        p.columns = rows;
        p.lines = rows <= 16 ? 16 : kStripLines;
        p.rest = float(l.family->rest);
        p.share = options_.share;
        p.compliance = l.compliance.data() + group * kStripLines;
        if (l.lambda.size() > 0)
          p.lambda = l.lambda.data() + (std::ptrdiff_t(group) * lattice.columns + start) * kStripLines;
        p.fresh = fresh;
        p.scratch = bench.scratch.data();
        parts_.kernels.line_strip(p);
      }
    }
    turn(begin, rows, bench, parts_.kernels.lanes_to_rows, false);
  }

  void turn(int begin, int rows, Bench& bench, void (*kernel)(const TransposeRows&), bool masses) {
    Lattice& lattice = parts_.lattice;
    for (int half = 0; half < rows; half += 16) {
      const Row3 from = lattice.x.row(begin + half), to = bench.tile.row(0);
      TransposeRows t{};
      t.stride = lattice.stride;
      t.pitch = kStripLines;
      t.row_count = std::min(16, rows - half);
      t.columns = lattice.columns;
      float* const arrays[4][2] = {{from.x, to.x},
                                   {from.y, to.y},
                                   {from.z, to.z},
                                   {lattice.w(begin + half), bench.w.data()}};
      for (int k = 0; k < (masses ? 4 : 3); ++k) {
        t.rows = arrays[k][0];
        t.lanes = arrays[k][1] + half;
        kernel(t);
      }
    }
  }

  Bench make_bench() const {
    const Lattice& l = parts_.lattice;
    // Transposing reads and writes whole tiles of four columns.
    const int columns = l.columns + 3;
    return {AlignedArray<float>(std::size_t(std::max(l.rows, l.columns)) * kStripScratch),
            Rows(columns, kStripLines), AlignedArray<float>(std::size_t(columns) * kStripLines)};
  }

  void set_compliance(double dt) {
    dt_ = dt;
    for (LineFamily& l : along_rows_)
      for (int j = 0; j < int(l.compliance.size()); ++j) l.compliance[j] = compliance(*l.family, j);
    for (LineFamily& l : between_rows_)
      for (int j = 0; j < int(l.compliance.size()); ++j)
        l.compliance[j] = compliance(*l.family, j / kStripLines);
  }
  float compliance(const Family& f, int j) const {
    const double real = options_.compliant ? compliance_of(parts_, f, j, dt_) : 0;
    return float(std::max(real, least_));
  }

  ClothParts parts_;
  LineOptions options_;
  double dt_ = 0;
  double least_ = 0;  // 1/kg
  std::vector<LineFamily> along_rows_, between_rows_;
  std::vector<Bench> benches_;
};

}  // namespace

std::unique_ptr<Stage> make_line(const ClothParts& parts, const LineOptions& options) {
  if (parts.families.empty()) return nullptr;
  return std::make_unique<Line>(parts, options);
}

}  // namespace weft::physics
