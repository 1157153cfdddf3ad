// --record and --replay beside a run.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "weft/recording.h"

namespace weft::cli {

class Recordings {
 public:
  // Paths, "" = not asked for. Reads the recording to be replayed; throws a Failure.
  Recordings(std::string record, const std::string& replay);

  // The recording that is replayed: its scene, seed and number of frames are those of the run.
  const std::optional<Recording>& replayed() const { return replayed_; }

  // The simulation stands at its start.
  void start(const Simulation& simulation);
  // Gives the inputs that were recorded before the next frame.
  void before_frame(Simulation& simulation);
  // Writes the frame's hash, and compares it; throws a Failure at the first that differs.
  void after_frame(const Simulation& simulation);
  // What is being written, or null.
  Recorder* recorder() { return recorder_.get(); }

 private:
  std::string path_;
  std::optional<Recording> replayed_;
  std::unique_ptr<Recorder> recorder_;
  std::size_t next_ = 0;
};

}  // namespace weft::cli
