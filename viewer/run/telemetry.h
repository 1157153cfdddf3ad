// What the panel tells of a running simulation, beside its picture.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "picture/frame_data.h"

namespace weft::viewer {

struct Telemetry {
  Status status;
  std::shared_ptr<const Plan> plan;  // as it is now
  Report report;                     // without contacts; measured now and then
  std::int64_t measured = 0;         // rises with every new report
  int substeps = 0, threads = 0;
  double dt = 0;            // s
  double frame_ms = 0;      // wall time of the last frame
  std::int64_t frames = 0;  // computed since the program started
  bool paused = false;
  double speed = 1;   // of real time, as asked for
  double pace = 0;    // s of physics per second, measured
  int kept = 0;       // states that can be gone back to
  int back = 0;       // how many of them lie after the one shown
  double kept_s = 0;  // s, from the first kept state to the last
  bool recording = false;
  bool exporting = false;
  std::string recorded;  // what a recording or an export was written to, once it is done
  std::string problem;   // what the last command could not do
  std::int64_t problems = 0;
  std::uint64_t hash = 0;  // of the state shown; 0 unless asked for
};

struct Shown {
  FrameData frame_data;
  Telemetry telemetry;
};

}  // namespace weft::viewer
