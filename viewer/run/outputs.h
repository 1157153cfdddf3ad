// What is written while a scene plays: a recording of the session, and an animation. One that cannot be written
// is given up: no file has a hole. Any thread may call, so that a window that closes can finish both while a
// long frame is still going on.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "weft/recording.h"

namespace weft::viewer {

class Outputs {
 public:
  // Begins a recording; the simulation stands at its start. Throws WriteError, as all below do.
  void record(const std::string& path, const Simulation& simulation);
  bool recording() const;
  // An input that was applied when the simulation stood at a frame.
  void input(std::int64_t frame, const Input& input);

  // Begins an animation, in a format of weft/output.h, with what the simulation is now.
  void export_to(const std::string& path, const Simulation& simulation);
  bool exporting() const;

  // Right after a frame.
  void frame(const Simulation& simulation);

  // Gives the file its name; where it was written, or "" where nothing is.
  std::string finish_recording();
  std::string finish_export();
  // Finishes both, once; what went wrong with that or while they were written, or "".
  std::string finish();

 private:
  template <class Output, class Write>
  std::optional<WriteError> attempt(std::unique_ptr<Output>& output, Write&& write);

  mutable std::mutex mutex_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<Animation> export_;
  bool finished_ = false;
  std::string problem_;
};

}  // namespace weft::viewer
