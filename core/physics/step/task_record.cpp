// The record of a frame's tasks (task_record.h).
#include "physics/step/task_record.h"

namespace weft::physics {

void TaskRecord::begin_frame() {
  sections_.clear();
  tasks_.clear();
  dependences_.clear();
  stage_.clear();
  standing_by_ = false;
  alone_since_ = 0;
  frame_ = Clock::now();
}

void TaskRecord::end_frame() {
  alone_until(now());
}

void TaskRecord::enter(std::string_view stage) {
  if (stage == stage_) return;
  alone_until(now());
  stage_ = stage;
}

void TaskRecord::gather() {
  alone_until(now());
  add(Section::Kind::gathered);
  standing_by_ = true;
}

void TaskRecord::open(std::size_t row_bytes) {
  alone_until(now());
  add(Section::Kind::shared).row_bytes = row_bytes;
}

void TaskRecord::close() {
  Section& s = sections_.back();
  s.tasks = tasks_.size() - s.first_task;
  s.dependences = dependences_.size() - s.first_dependence;
  alone_since_ = now();
}

void TaskRecord::begin(int number, RowSpan rows, int first_substep, int substeps) {
  tasks_.push_back({number, now(), 0, rows, first_substep, substeps});
}

void TaskRecord::end() {
  tasks_.back().nanoseconds = now() - tasks_.back().start;
}

double TaskRecord::now() const {
  return std::chrono::duration<double, std::nano>(Clock::now() - frame_).count();
}

// What has been done since the last section, one thread has done alone.
void TaskRecord::alone_until(double time) {
  Section& s = add(Section::Kind::alone);
  s.tasks = 1;
  tasks_.push_back({0, alone_since_, time - alone_since_, {}, 0, 0});
  alone_since_ = time;
}

Section& TaskRecord::add(Section::Kind kind) {
  Section& s = sections_.emplace_back();
  s.kind = kind;
  s.stage = stage_;
  s.standing_by = standing_by_;
  s.first_task = tasks_.size();
  s.first_dependence = dependences_.size();
  return s;
}

}  // namespace weft::physics
