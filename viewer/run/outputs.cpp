// A recording and an animation behind one lock.
#include "run/outputs.h"

#include "weft/printable.h"

namespace weft::viewer {

namespace {

std::string finish(std::unique_ptr<Recorder>& recorder) {
  if (!recorder) return "";
  const std::unique_ptr<Recorder> done = std::move(recorder);
  done->finish();
  return printable(done->path());
}

std::string finish(std::unique_ptr<Animation>& animation) {
  if (!animation) return "";
  const std::unique_ptr<Animation> done = std::move(animation);
  done->finish();
  return printable(done->written());
}

}  // namespace

void Outputs::record(const std::string& path, const Simulation& simulation) {
  const std::lock_guard lock(mutex_);
  if (!finished_) recorder_ = std::make_unique<Recorder>(path, simulation);
}

bool Outputs::recording() const {
  const std::lock_guard lock(mutex_);
  return recorder_ != nullptr;
}

void Outputs::input(std::int64_t frame, const Input& input) {
  const std::lock_guard lock(mutex_);
  if (recorder_) recorder_->input(frame, input);
}

void Outputs::export_to(const std::string& path, const Simulation& simulation) {
  const std::lock_guard lock(mutex_);
  if (finished_) return;
  export_ = open_animation(path, simulation.view());
  export_->append(simulation.view());
}

bool Outputs::exporting() const {
  const std::lock_guard lock(mutex_);
  return export_ != nullptr;
}

void Outputs::frame(const Simulation& simulation) {
  const std::lock_guard lock(mutex_);
  if (recorder_) recorder_->frame(simulation);
  if (export_) export_->append(simulation.view());
}

std::string Outputs::finish_recording() {
  const std::lock_guard lock(mutex_);
  return viewer::finish(recorder_);
}

std::string Outputs::finish_export() {
  const std::lock_guard lock(mutex_);
  return viewer::finish(export_);
}

std::string Outputs::finish() {
  const std::lock_guard lock(mutex_);
  finished_ = true;
  const auto attempt = [&](auto& output) {
    try {
      viewer::finish(output);
    } catch (const WriteError& error) {
      problem_ += (problem_.empty() ? "" : "\n") + printable(error.path) + ": " + error.what();
    }
  };
  attempt(recorder_);
  attempt(export_);
  return problem_;
}

}  // namespace weft::viewer
