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

// What goes wrong with one of them, which then is no more.
template <class Output, class Write>
std::optional<WriteError> Outputs::attempt(std::unique_ptr<Output>& output, Write&& write) {
  try {
    if (output) write(*output);
    return std::nullopt;
  } catch (const WriteError& error) {
    output.reset();
    problem_ += (problem_.empty() ? "" : "\n") + printable(error.path) + ": " + error.what();
    return error;
  }
}

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
  const auto failed = attempt(recorder_, [&](Recorder& to) { to.input(frame, input); });
  if (failed) throw WriteError(*failed);
}

void Outputs::export_to(const std::string& path, const Simulation& simulation, std::int64_t first,
                        std::optional<std::int64_t> last) {
  const std::lock_guard lock(mutex_);
  if (finished_) return;
  export_ = open_animation(path, simulation.view(), last ? *last - first + 1 : 0);
  first_ = first;
  last_ = last;
  if (simulation.frame() == first) export_->append(simulation.view());
}

bool Outputs::exporting() const {
  const std::lock_guard lock(mutex_);
  return export_ != nullptr;
}

std::string Outputs::frame(const Simulation& simulation) {
  const std::lock_guard lock(mutex_);
  const auto no_recording = attempt(recorder_, [&](Recorder& to) { to.frame(simulation); });
  const auto no_export = attempt(export_, [&](Animation& to) {
    if (simulation.frame() >= first_) to.append(simulation.view());
  });
  if (no_recording) throw WriteError(*no_recording);
  if (no_export) throw WriteError(*no_export);
  return last_ && simulation.frame() >= *last_ ? viewer::finish(export_) : "";
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
  attempt(recorder_, [](Recorder& to) { to.finish(); });
  attempt(export_, [](Animation& to) { to.finish(); });
  recorder_.reset();
  export_.reset();
  return problem_;
}

}  // namespace weft::viewer
