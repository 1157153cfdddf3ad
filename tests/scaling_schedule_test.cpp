// The list schedule of bench/scaling against graphs whose shortest time is known: independent tasks, a chain, a
// fork and join, a wavefront of rows and substeps; and what it says of starts, signals, memory and rows that change
// hands.
#include <gtest/gtest.h>

#include "../bench/list_schedule.h"

namespace bench {
namespace {

using weft::physics::RowSpan;
using Kind = weft::physics::Section::Kind;

GraphSection tasks(int count, double ns) {
  GraphSection s;
  s.kind = Kind::shared;
  s.stage = "tasks";
  s.standing_by = true;
  for (int n = 0; n < count; ++n) s.tasks.push_back({n, 0, ns, {}, 0, 0});
  return s;
}

GraphSection alone(double ns) {
  GraphSection s;
  s.stage = "alone";
  s.tasks.push_back({0, 0, ns, {}, 0, 0});
  return s;
}

double time_of(const TaskGraph& graph, const Host& host) {
  return foretell(graph, host).ns;
}

Host workers(int count) {
  Host host;
  host.workers = count;
  return host;
}

TEST(ListSchedule, IndependentTasksFillTheWorkers) {
  for (const int count : {1, 5, 16, 100})
    for (const int p : {1, 2, 3, 16, 64}) {
      const TaskGraph graph{{tasks(count, 7)}};
      EXPECT_DOUBLE_EQ(time_of(graph, workers(p)), 7.0 * ((count + p - 1) / p));
      EXPECT_DOUBLE_EQ(graph.work_ns(), 7.0 * count);
      EXPECT_DOUBLE_EQ(graph.path_ns(), 7);
    }
}

TEST(ListSchedule, AChainTakesAsLongOnAnyNumber) {
  GraphSection chain = tasks(40, 3);
  for (int n = 1; n < 40; ++n) chain.dependences.push_back({n - 1, n});
  for (const int p : {1, 2, 16}) EXPECT_DOUBLE_EQ(time_of({{chain}}, workers(p)), 120);
  EXPECT_DOUBLE_EQ((TaskGraph{{chain}}.path_ns()), 120);
  // Whoever ends a task goes on with the next: no signal, but a start each.
  Host host = workers(4);
  host.start_ns = 2, host.signal_ns = 50;
  EXPECT_DOUBLE_EQ(time_of({{chain}}, host), 40 * (3 + 2));
}

TEST(ListSchedule, ForkAndJoinCountSignals) {
  const TaskGraph graph{{alone(10), tasks(8, 100), alone(20)}};
  EXPECT_DOUBLE_EQ(time_of(graph, workers(8)), 130);
  EXPECT_DOUBLE_EQ(time_of(graph, workers(1)), 830);
  Host host = workers(8);
  host.start_ns = 1, host.signal_ns = 5;
  // The others see the tasks after a signal, and the first sees their ends after another.
  EXPECT_DOUBLE_EQ(time_of(graph, host), 10 + 5 + 101 + 5 + 20);
  // Where nobody stands by, the others come so late that the first has done all but what they take then.
  TaskGraph woken = graph;
  woken.sections[1].standing_by = false;
  host.wake_ns = 350;
  EXPECT_DOUBLE_EQ(time_of(woken, host), 10 + 350 + 101 + 5 + 20);
  host.wake_ns = 1e6;
  EXPECT_DOUBLE_EQ(time_of(woken, host), 10 + 8 * 101 + 20);
}

TEST(ListSchedule, ThreadsThatAreCalledComeLater) {
  GraphSection gathered;
  gathered.kind = Kind::gathered;
  const TaskGraph graph{{gathered, alone(300), tasks(2, 100)}};
  Host host = workers(2);
  host.wake_ns = 350;
  EXPECT_DOUBLE_EQ(time_of(graph, host), 300 + 50 + 100);
  host.wake_ns = 200;
  EXPECT_DOUBLE_EQ(time_of(graph, host), 300 + 100);
}

// Tile k of chunk c waits for tile k-1 of its chunk, and for tile k+lag of the chunk before, or that one's last.
GraphSection wavefront(int tiles, int chunks, int lag) {
  GraphSection s = tasks(tiles * chunks, 1);
  for (int c = 0; c < chunks; ++c)
    for (int k = 0; k < tiles; ++k) {
      if (k + 1 < tiles) s.dependences.push_back({c * tiles + k, c * tiles + k + 1});
      if (c + 1 < chunks && k >= lag)
        s.dependences.push_back({c * tiles + k, (c + 1) * tiles + k - lag});
    }
  return s;
}

// With workers for all chunks at once, each begins lag + 1 tiles after the one before. With P, as many chunks for
// each, and a sheet of P (lag + 1) tiles at least, nobody waits but at both ends.
TEST(ListSchedule, AWavefrontIsAsFastAsItCanBe) {
  for (const int lag : {0, 1, 3})
    for (const int chunks : {1, 4, 16}) {
      const TaskGraph graph{{wavefront(64, chunks, lag)}};
      EXPECT_DOUBLE_EQ(time_of(graph, workers(64)), 64 + (chunks - 1) * (lag + 1)) << lag;
      EXPECT_DOUBLE_EQ(graph.path_ns(), 64 + (chunks - 1) * (lag + 1));
      EXPECT_DOUBLE_EQ(time_of(graph, workers(1)), 64 * chunks);
      for (const int p : {2, 4})
        if (chunks % p == 0) {
          EXPECT_DOUBLE_EQ(time_of(graph, workers(p)), 64 * chunks / p + (p - 1) * (lag + 1))
              << lag << " " << p;
        }
    }
}

TEST(ListSchedule, MemoryIsShared) {
  GraphSection s = tasks(8, 100);
  s.row_bytes = 1000;
  for (int n = 0; n < 8; ++n) s.tasks[std::size_t(n)].rows = {n, n + 1};
  Host host = workers(8);
  EXPECT_DOUBLE_EQ(time_of({{s}}, host), 100);  // caches without bounds hold everything
  host.cache_bytes = 1000;
  EXPECT_DOUBLE_EQ(foretell({{s}}, host).memory_bytes, 8000);
  host.rate = 80;
  EXPECT_NEAR(time_of({{s}}, host), 100, 1e-9);
  host.rate = 20;
  EXPECT_NEAR(time_of({{s}}, host), 400, 1e-9);
  host.core_rate = 5;  // a worker by itself takes twice as long
  EXPECT_NEAR(time_of({{s}}, host), 400, 1e-9);
  host.rate = Host::kNone;
  EXPECT_NEAR(time_of({{s}}, host), 200, 1e-9);
}

TEST(ListSchedule, RowsOfAnotherWorkerCost) {
  GraphSection s = tasks(2, 100);
  s.row_bytes = 10;
  s.tasks[0].rows = s.tasks[1].rows = {0, 5};
  Host host = workers(2);
  host.handover_ns = 2;
  EXPECT_DOUBLE_EQ(time_of({{s}}, host), 200);  // side by side, the second takes over 50 bytes
  host.workers = 1;
  EXPECT_DOUBLE_EQ(time_of({{s}}, host), 200);
}

TEST(TaskGraph, TheShorterOfTwoRecordsCounts) {
  TaskGraph a{{tasks(2, 10), alone(5)}}, b = a;
  a.sections[0].tasks[1].nanoseconds = 4;
  b.sections[0].tasks[0].nanoseconds = 7;
  b.sections[1].tasks[0].nanoseconds = 9;
  a.take_shorter(b);
  EXPECT_DOUBLE_EQ(a.work_ns(), 7 + 4 + 5);
  const TaskGraph other{{tasks(3, 1), alone(1)}};  // cut in another way
  a.take_shorter(other);
  EXPECT_DOUBLE_EQ(a.work_ns(), 4);
}

}  // namespace
}  // namespace bench
