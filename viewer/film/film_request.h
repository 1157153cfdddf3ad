// What is to be filmed, and how large.
#pragma once

#include <cstdint>

namespace weft::viewer {

// Frames of the scene: from now on until it is ended, or from the first to the last.
struct FrameRange {
  bool endless = true;
  int first = 0, last = 0;
};

struct FilmRequest {
  int width = 0, height = 0;  // pixels; 0: as the view
  FrameRange range;
};

}  // namespace weft::viewer
