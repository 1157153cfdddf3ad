// The record of a frame's tasks: running it alone gives the same result as threads do; every two tasks of a
// wavefront that touch the same row wait for each other, one way or the other, by what has been written down; every
// row of every substep is in it once; durations and what lies between them make up the frame.
#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <set>

#include "physics/frame/state.h"
#include "physics/step/task_record.h"
#include "physics/step/threads.h"
#include "physics/step/wavefront.h"
#include "weft/random.h"
#include "weft/read_scene.h"

namespace weft::physics {
namespace {

class Touching final : public RowStage {
 public:
  Touching(int rows_reached, std::vector<std::uint64_t>& rows)
      : RowStage("touch", "", rows_reached, 1, "rows"), rows_(rows) {}
  using RowStage::run;
  void run(int j, const Substep& s) override {
    for (int k = j; k <= std::min(j + reach, int(rows_.size()) - 1); ++k) {
      std::uint64_t& row = rows_[std::size_t(k)];
      row = (row ^ std::uint64_t(s.time * 1024 + j)) * 0x9e3779b97f4a7c15u;
      row ^= row >> 31;
    }
  }

 private:
  std::vector<std::uint64_t>& rows_;
};

struct Ran {
  std::vector<std::uint64_t> rows;
  TaskRecord record;
};

void run(Ran& ran, const std::vector<int>& reaches, int rows, int substeps, int count,
         bool recorded) {
  ran.rows.assign(std::size_t(rows), 1);
  std::deque<Touching> stages;
  std::vector<RowStage*> pointers;
  for (const int reach : reaches) pointers.push_back(&stages.emplace_back(reach, ran.rows));
  Wavefront wavefront(pointers, rows, 1000, 500);
  Threads threads(count);
  if (recorded) threads.record(&ran.record);
  ran.record.begin_frame();
  threads.together([&] { wavefront.run({0, 0.125, substeps, 0.125}, threads); });
  ran.record.end_frame();
}

// Whether each task comes before each other, by dependences alone.
std::vector<std::vector<bool>> order_of(std::span<const Task> tasks,
                                        std::span<const Dependence> dependences) {
  std::map<int, std::size_t> place;
  for (const Task& t : tasks) place[t.number] = place.size();
  std::vector<std::vector<bool>> before(tasks.size(), std::vector<bool>(tasks.size()));
  // Tasks stand in an order in which they can run, so one pass from the front sees all.
  std::vector<std::vector<std::size_t>> earlier(tasks.size());
  for (const Dependence& d : dependences) earlier[place.at(d.after)].push_back(place.at(d.before));
  for (std::size_t n = 0; n < tasks.size(); ++n)
    for (const std::size_t e : earlier[n]) {
      EXPECT_LT(e, n);
      before[e][n] = true;
      for (std::size_t m = 0; m < n; ++m)
        if (before[m][e]) before[m][n] = true;
    }
  return before;
}

TEST(TaskRecord, DependencesOrderAllThatTouchesARow) {
  Random random(3, 0);
  const auto below = [&](int n) { return int(random.bits() % std::uint64_t(n)); };
  for (int n = 0; n < 40; ++n) {
    std::vector<int> reaches;
    for (int q = 1 + below(4); q > 0; --q) reaches.push_back(below(3));
    const int rows = 20 + below(60), substeps = 2 + below(20), threads = 2 + below(15);
    Ran recorded, plain;
    run(recorded, reaches, rows, substeps, threads, true);
    run(plain, reaches, rows, substeps, 1, false);
    ASSERT_EQ(recorded.rows, plain.rows) << n;
    for (const Section& s : recorded.record.sections()) {
      if (s.kind != Section::Kind::shared) continue;
      const auto tasks = recorded.record.tasks(s);
      const auto before = order_of(tasks, recorded.record.dependences(s));
      for (std::size_t a = 0; a < tasks.size(); ++a)
        for (std::size_t b = a + 1; b < tasks.size(); ++b) {
          const bool meet =
              tasks[a].rows.begin < tasks[b].rows.end && tasks[b].rows.begin < tasks[a].rows.end;
          EXPECT_TRUE(!meet || before[a][b])
              << n << ": tasks " << tasks[a].number << " and " << tasks[b].number;
        }
      // Every substep is worked on by one chunk of tasks, which reach every row.
      std::map<int, std::set<int>> touched;
      for (const Task& t : tasks)
        for (int k = 0; k < t.substeps; ++k)
          for (int j = t.rows.begin; j < t.rows.end; ++j) touched[t.first_substep + k].insert(j);
      EXPECT_EQ(int(touched.size()), substeps);
      for (const auto& [substep, all] : touched) EXPECT_EQ(int(all.size()), rows);
    }
  }
}

TEST(TaskRecord, ThreadsRunSharesInTurnAndTellThem) {
  TaskRecord record;
  Threads threads(5);
  threads.record(&record);
  EXPECT_EQ(threads.running(), 1);
  std::vector<std::size_t> ran;
  record.begin_frame();
  record.enter("woken");
  threads.share(3, false, [&](std::size_t n) { ran.push_back(n); });
  record.enter("gathered");
  threads.together([&] {
    threads.share(4, false, [&](std::size_t n) { ran.push_back(n); });
    threads.share(2, true, [&](std::size_t n) { ran.push_back(n); });
  });
  record.end_frame();
  EXPECT_EQ(ran, (std::vector<std::size_t>{0, 1, 2, 0, 1, 2, 3, 0, 1}));
  std::vector<std::string> shared;
  double last = 0;
  for (const Section& s : record.sections()) {
    if (s.kind == Section::Kind::shared)
      shared.push_back(s.stage + std::to_string(s.tasks) + (s.standing_by ? " by" : ""));
    for (const Task& t : record.tasks(s)) {
      EXPECT_GE(t.start, last);
      last = t.start + t.nanoseconds;
    }
  }
  EXPECT_EQ(shared, (std::vector<std::string>{"woken3", "gathered4 by"}));
  threads.record(nullptr);
  EXPECT_EQ(threads.running(), 5);
}

TEST(TaskRecord, AFrameIsTheSameAndItsTasksMakeItUp) {
  for (const std::string name : {"swing", "inextensible", "fold50"}) {
    std::vector<Override> large;
    if (name != "fold50")
      large = {{"/cloths/0/grid/points", "[180,180]"}, {"/cloths/0/pins", "[[0,0],[179,0]]"}};
    const SceneFile file = read_scene(name, large);
    ASSERT_TRUE(file.faults.empty()) << name;
    Simulation plain(file.scene, {.threads = 1});
    Simulation::State state(file.scene, {.threads = 16}, {});
    TaskRecord record;
    state.runner.threads().record(&record);
    for (int frame = 0; frame < 3; ++frame) {
      plain.advance_frame();
      record.begin_frame();
      state.advance_frame();
      record.end_frame();
    }
    std::size_t shared = 0;
    double sum = 0, end = 0;
    for (const Section& s : record.sections()) {
      shared += s.kind == Section::Kind::shared;
      for (const Task& t : record.tasks(s)) sum += t.nanoseconds, end = t.start + t.nanoseconds;
    }
    EXPECT_GT(shared, 0u) << name;
    EXPECT_LE(sum, end * (1 + 1e-9)) << name;
    EXPECT_GT(sum, 0.5 * end) << name;  // else much is between tasks that nobody counts
    const Snapshot one = plain.snapshot(), many = state.snapshot();
    EXPECT_EQ(one.cloths[0].positions, many.cloths[0].positions) << name;
    EXPECT_EQ(one.cloths[0].velocities, many.cloths[0].velocities) << name;
  }
}

}  // namespace
}  // namespace weft::physics
