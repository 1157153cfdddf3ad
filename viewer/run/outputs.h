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

  // Begins an animation of the frames first … last, in a format of weft/output.h; the simulation is not past
  // the first. Without a last one it goes on until finish_export().
  void export_to(const std::string& path, const Simulation& simulation, std::int64_t first,
                 std::optional<std::int64_t> last);
  bool exporting() const;

  // Right after a frame. Where the animation is written after its last frame, or "".
  std::string frame(const Simulation& simulation);

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
  std::int64_t first_ = 0;  // frame of the export
  std::optional<std::int64_t> last_;
  bool finished_ = false;
  std::string problem_;
};

}  // namespace weft::viewer
