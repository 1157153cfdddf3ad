// The files of a run: which may be written at all, and when they take their names.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recordings.h"
#include "weft/output.h"

namespace weft::cli {

// Paths; "" = not asked for.
struct FileNames {
  std::string report, dump, animation, record, replay;
};

// Throws a Failure where two outputs, of an animation any of its files, would go to one file, or one
// would overwrite the scene (a path, "" = none), the recording that is replayed, or what this program prints.
void refuse_clashes(const FileNames& names, const std::string& scene, std::int64_t samples);

// Opened before the run starts, so that a path that cannot be written costs nothing.
class Files {
 public:
  Files(const FileNames& names, const Simulation& simulation, std::int64_t frames,
        Recordings& recordings);

  // Takes in the frame just computed.
  void frame(const Simulation& simulation);

  // Gives all files their names, once all are complete; the report comes last: when it is there, so
  // are they. A simulation that stopped itself has no final positions: it leaves no dump.
  void finish(const Simulation& simulation, const Report& report);
  // The same within a frame, of which nothing is known: neither dump nor report.
  void finish_within_frame();

  // What has been written, as it can be shown.
  const std::vector<std::string>& written() const { return written_; }
  // What was asked for and is not written.
  std::vector<std::string> missing() const;

 private:
  void finish(bool dump, bool report);

  std::unique_ptr<Animation> animation_;
  std::optional<OutputFile> dump_, report_;
  Recordings& recordings_;
  std::vector<std::string> written_;
  bool dumped_ = false, reported_ = false;
};

}  // namespace weft::cli
