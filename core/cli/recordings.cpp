// Recording and replaying, with the program's failures.
#include "recordings.h"

#include "failure.h"

namespace weft::cli {

Recordings::Recordings(std::string record, const std::string& replay) : path_(std::move(record)) {
  if (replay.empty()) return;
  try {
    replayed_ = read_recording(replay);
  } catch (const RecordingError& error) {
    throw Failure{kBadScene, {{"--replay", error.what(), "a file that --record wrote"}}};
  }
}

void Recordings::start(const Simulation& simulation) {
  if (!path_.empty()) recorder_ = std::make_unique<Recorder>(path_, simulation);
}

void Recordings::before_frame(Simulation& simulation) {
  if (!replayed_) return;
  try {
    while (const Input* input = next_input(*replayed_, next_, simulation)) {
      const std::int64_t frame = simulation.frame();
      apply(*input, simulation);
      if (recorder_) recorder_->input(frame, *input);
    }
  } catch (const std::exception& error) {  // an input that this scene has no place for
    const std::string where = "before frame " + std::to_string(simulation.frame() + 1) + ": ";
    throw Failure{kStopped, {{"--replay", where + error.what(), "a file that --record wrote"}}};
  }
}

void Recordings::after_frame(const Simulation& simulation) {
  if (recorder_) recorder_->frame(simulation);
  if (!replayed_) return;
  try {
    compare_hash(*replayed_, next_, simulation);
  } catch (const RecordingError& error) {
    throw Failure{kStopped, {{"--replay", error.what(), ""}}};
  }
}

}  // namespace weft::cli
