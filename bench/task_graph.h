// The tasks of one frame as several threads would get them, with durations on one thread and with what each waits
// for.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "physics/step/task_record.h"

namespace bench {

// As physics::Section, with its own tasks.
struct GraphSection {
  weft::physics::Section::Kind kind = weft::physics::Section::Kind::alone;
  std::string stage;
  bool standing_by = false;
  std::size_t row_bytes = 0;
  std::vector<weft::physics::Task> tasks;
  std::vector<weft::physics::Dependence> dependences;
};

struct TaskGraph {
  std::vector<GraphSection> sections;

  double work_ns() const;  // of all tasks
  // The longest chain of tasks that wait for each other.
  double path_ns() const;
  // Of the same frame, recorded again: every task takes the shorter of both durations. What was cut in another
  // way, since some thresholds look at times, is as a whole the shorter of both.
  void take_shorter(const TaskGraph& again);
};

TaskGraph graph_of(const weft::physics::TaskRecord& record);

// How tasks of a section wait for each other, by their places in it.
struct Successors {
  explicit Successors(const GraphSection& section);
  std::vector<std::vector<int>>
      after;               // of each task, in the order in which the schedule lets them go
  std::vector<int> waits;  // for how many each waits
};

}  // namespace bench
