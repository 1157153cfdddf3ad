// The program's command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "renderer.h"
#include "weft/read_scene.h"

namespace weft::viewer {

struct Arguments {
  std::string scene;  // "": the first shipped scene
  std::vector<Override> overrides;
  std::string look = "colour";
  bool headless = false;
  std::int64_t frames = 0;  // headless: which frame; window: ends after so many, 0 = never
  int width = 1280, height = 720;
  std::string out;  // PNG
  bool panel = false;
  bool paused = false;
  std::string state;  // file that tells what the window shows, for scripts
  int threads = 0;
  std::uint64_t seed = 1;
  std::optional<double> azimuth, elevation;  // degrees
  double zoom = 1;
  PictureFiles pictures;
  LookSettings settings;
};

// Ends with an exit code (--help, a wrong command line), or gives the arguments.
std::optional<int> parse_arguments(int count, char** words, Arguments& arguments);

}  // namespace weft::viewer
