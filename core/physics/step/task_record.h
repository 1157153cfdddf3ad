// What frames on several threads are made of, to foretell how long they take on so many: one thread runs the tasks
// that several would get, one after the other, and they are kept here with their durations and with what each has to
// wait for (Threads::record).
//
// A frame is a chain of sections, each of which is over before the next begins: what one thread does alone, or tasks
// that several do. Tasks wait for tasks of their own section only.
#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "physics/step/stage.h"

namespace weft::physics {

// What a thread does in one go.
struct Task {
  int number = 0;          // by which dependences name it; in one section no two are alike
  double start = 0;        // ns, from the beginning of the frame
  double nanoseconds = 0;  // that it took
  RowSpan rows;            // that it works on, and
  int first_substep = 0;   // in which substeps of the run of stages,
  int substeps = 0;        // how many; 0: neither is known
};

// Task `after` cannot begin before task `before` has ended.
struct Dependence {
  int before = 0, after = 0;
};

struct Section {
  enum class Kind {
    alone,     // one task, on the thread that runs the frame
    gathered,  // no tasks: the other threads are called, to stand by from here on
    shared,  // threads that stand by take part, or that have to be woken, where none has been called
  };
  Kind kind = Kind::alone;
  std::string stage;                      // stages that it belongs to, or ""
  bool standing_by = false;               // the other threads, when it began
  std::size_t row_bytes = 0;              // of the rows that its tasks name
  std::size_t first_task = 0, tasks = 0;  // of TaskRecord::tasks()
  std::size_t first_dependence = 0, dependences = 0;
};

class TaskRecord {
 public:
  // A frame begins, and ends: what there was before is forgotten.
  void begin_frame();
  void end_frame();

  const std::vector<Section>& sections() const { return sections_; }
  std::span<const Task> tasks(const Section& s) const {
    return std::span(tasks_).subspan(s.first_task, s.tasks);
  }
  // In the order in which the schedule told them.
  std::span<const Dependence> dependences(const Section& s) const {
    return std::span(dependences_).subspan(s.first_dependence, s.dependences);
  }

  // For those who run the frame. From here on it is this stage's.
  void enter(std::string_view stage);
  // Others are called to stand by, until they leave.
  void gather();
  void leave() { standing_by_ = false; }
  // Tasks that may run side by side come; all of them are done.
  void open(std::size_t row_bytes = 0);
  void close();
  // A task of the open section. Of tasks within a task nothing is kept.
  void begin(int number, RowSpan rows = {}, int first_substep = 0, int substeps = 0);
  void end();
  void depends(int after, int before) { dependences_.push_back({before, after}); }

 private:
  using Clock = std::chrono::steady_clock;
  double now() const;
  void alone_until(double time);
  Section& add(Section::Kind kind);

  std::vector<Section> sections_;
  std::vector<Task> tasks_;
  std::vector<Dependence> dependences_;
  std::string stage_;
  bool standing_by_ = false;
  Clock::time_point frame_;
  double alone_since_ = 0;  // ns
};

}  // namespace weft::physics
