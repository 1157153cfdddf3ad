// The wavefront gives what running the stages one after the other gives, for any number of threads,
// shape of tiles, stages, reaches, rows and substeps. The stages here mix integers: every value
// depends on the order of all that was done to its rows before. And it keeps rows as they were before
// all stages, and looks at them after all.
#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <deque>
#include <thread>

#include "physics/frame/rollback_buffer.h"
#include "physics/step/threads.h"
#include "physics/step/wavefront.h"
#include "weft/random.h"

namespace weft::physics {
namespace {

std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = (a ^ (b + 0x9e3779b97f4a7c15u + (a << 6))) * 0xbf58476d1ce4e5b9u;
  return z ^ (z >> 29);
}

// Rows of integers, and rows of one particle that show them.
struct Mixed {
  explicit Mixed(int rows)
      : values(std::size_t(rows), 1), particles(std::vector<int>(std::size_t(rows), 1), false) {
    for (int j = 0; j < rows; ++j) particles.w(j)[0] = 1;
  }
  void set(int j, std::uint64_t value) {
    values[std::size_t(j)] = value;
    particles.x.at(0, j, 0) = shown(j);
    particles.v.at(1, j, 0) = shown(j);
  }
  float shown(int j) const { return float(values[std::size_t(j)] % 1000); }

  std::vector<std::uint64_t> values;
  Particles particles;
};

// Reads and rewrites rows j … j+reach. Where rows reach others, they come in order, and carry a value
// from one to the next of a substep.
class MixingStage final : public RowStage {
 public:
  MixingStage(int number, int reach, Mixed& rows)
      : RowStage("mix", "", reach, 1, "rows"), number_(number), rows_(rows) {}

  using RowStage::run;
  void reserve_slots(int slots) override {
    carried_.assign(std::size_t(slots), 0);
    next_row_.assign(std::size_t(slots), 0);
  }
  void run(int j, const Substep& s) override {
    const auto slot = std::size_t(s.slot);
    if (reach > 0) {
      if (j == 0) {
        carried_[slot] = std::uint64_t(number_);
        next_row_[slot] = 0;
      }
      if (next_row_[slot] != j) out_of_order_ = true;
      next_row_[slot] = j + 1;
    }
    if ((j + 5 * number_) % 61 == 0)
      std::this_thread::yield();  // lets other threads come in between
    std::uint64_t value =
        mixed(reach > 0 ? carried_[slot] : std::uint64_t(j), std::bit_cast<std::uint64_t>(s.time));
    value = mixed(value, std::bit_cast<std::uint64_t>(s.dt));
    value = mixed(value, std::bit_cast<std::uint64_t>(s.kick));
    for (int k = j; k <= std::min(j + reach, rows_.particles.rows - 1); ++k) {
      value = mixed(value, rows_.values[std::size_t(k)]);
      rows_.set(k, mixed(value, std::uint64_t(k)));
    }
    if (reach > 0) carried_[slot] = value;
    ++calls_;
  }
  bool out_of_order() const { return out_of_order_; }
  std::int64_t calls() const { return calls_; }

 private:
  int number_;
  Mixed& rows_;
  std::vector<std::uint64_t> carried_;
  std::vector<int> next_row_;
  std::atomic<bool> out_of_order_{false};
  std::atomic<std::int64_t> calls_{0};
};

struct Layout {
  int rows = 0;
  std::vector<int> reaches;
  std::vector<int> substeps;  // of each frame
  std::size_t row_bytes = 0;
  double row_nanoseconds = 0;
};

Layout random_layout(Random& random) {
  const auto below = [&](int n) { return int(random.bits() % std::uint64_t(n)); };
  Layout s;
  s.rows = 1 + below(below(2) ? 300 : 12);
  for (int q = 1 + below(9); q > 0; --q) s.reaches.push_back(below(3) ? below(3) : below(9));
  for (int frame = 0; frame < 3; ++frame)
    s.substeps.push_back(1 + below(below(3) ? (below(4) ? 25 : 100) : 1));
  s.row_bytes = std::size_t(1 + below(3) * 60000 + below(2000));
  s.row_nanoseconds = below(2) ? 1 : below(20000);
  return s;
}

std::vector<std::uint64_t> one_after_the_other(const Layout& layout) {
  Mixed rows(layout.rows);
  for (std::size_t frame = 0; frame < layout.substeps.size(); ++frame)
    for (int s = 0; s < layout.substeps[frame]; ++s)
      for (std::size_t q = 0; q < layout.reaches.size(); ++q) {
        MixingStage stage(int(q), layout.reaches[q], rows);
        stage.reserve(1);
        for (int j = 0; j < layout.rows; ++j)
          stage.run(j, {0.125, double(frame) * 10 + (s + 1) * 0.125, s == 0 ? 0.1 : 0.125, 0});
      }
  return rows.values;
}

std::vector<std::uint64_t> by_wavefront(const Layout& layout, int thread_count) {
  Mixed rows(layout.rows);
  RollbackBuffer record(rows.particles, {0, -1, 0}, kernel_table(Simd::scalar));
  std::deque<MixingStage> stages;
  std::vector<RowStage*> pointers;
  for (const int reach : layout.reaches)
    pointers.push_back(&stages.emplace_back(int(stages.size()), reach, rows));
  Wavefront wavefront(pointers, layout.rows, layout.row_bytes, layout.row_nanoseconds);
  Threads threads(thread_count);
  std::int64_t substeps = 0;
  for (std::size_t frame = 0; frame < layout.substeps.size(); ++frame) {
    std::vector<float> before;
    for (int j = 0; j < layout.rows; ++j) before.push_back(rows.particles.x.at(0, j, 0));
    wavefront.run({double(frame) * 10, 0.125, layout.substeps[frame], 0.1}, threads, {}, &record);
    substeps += layout.substeps[frame];
    float greatest = 0;
    double kinetic = 0;
    for (int j = 0; j < layout.rows; ++j) {
      EXPECT_EQ(record.x().at(0, j, 0), before[std::size_t(j)]) << "row " << j;
      greatest = std::max(greatest, rows.shown(j));
      kinetic += 0.5 * rows.shown(j) * rows.shown(j);
    }
    EXPECT_EQ(record.energy_sum().greatest, greatest);
    EXPECT_EQ(record.energy_sum().kinetic, kinetic);
  }
  for (const MixingStage& stage : stages) {
    EXPECT_FALSE(stage.out_of_order());
    EXPECT_EQ(stage.calls(), substeps * layout.rows);
  }
  return rows.values;
}

class WavefrontOfThreads : public testing::TestWithParam<int> {};

TEST_P(WavefrontOfThreads, EqualsStageAfterStage) {
  Random random(17, std::uint64_t(GetParam()));
  for (int n = 0; n < 100; ++n) {
    const Layout layout = random_layout(random);
    std::string reaches;
    for (const int reach : layout.reaches) reaches += " " + std::to_string(reach);
    ASSERT_EQ(by_wavefront(layout, GetParam()), one_after_the_other(layout))
        << "layout " << n << ": " << layout.rows << " rows, reaches" << reaches << ", "
        << layout.row_bytes << " bytes and " << layout.row_nanoseconds << " ns a row";
  }
}

INSTANTIATE_TEST_SUITE_P(, WavefrontOfThreads, testing::Values(1, 2, 3, 4, 8),
                         [](const auto& test) { return std::to_string(test.param); });

}  // namespace
}  // namespace weft::physics
