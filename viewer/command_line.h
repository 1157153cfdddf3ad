// The program's command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "picture/renderer.h"
#include "weft/read_scene.h"

namespace weft::viewer {

struct Arguments {
  std::string scene;  // "": the first shipped scene
  std::vector<Override> overrides;
  std::string look = "colour";
  bool headless = false;
  std::int64_t frames = 0;         // to simulate before the picture
  int strip = 1;                   // pictures side by side, from the start to that frame
  int width = 1280, height = 720;  // of one picture, pixels
  std::string out;                 // PNG
  bool paused = false;             // the window opens with the scene at rest
  std::string keys;                // the file of keys; "": a person's own
  std::string log;                 // tells the state of the window, line by line
  double measure = 0;              // s to measure the window for, then it closes; 0: it stays
  std::string record;              // a recording of the session from its start
  int threads = 0;
  std::uint64_t seed = 1;
  std::optional<double> azimuth, elevation, zoom;  // in place of the scene's: degrees, > 1 nearer
  PictureFiles pictures;
  LookSettings settings;
};

// Ends with an exit code (--help, a wrong command line), or gives the arguments.
std::optional<int> parse_arguments(int count, char** words, Arguments& arguments);

}  // namespace weft::viewer
