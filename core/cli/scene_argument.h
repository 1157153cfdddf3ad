// The argument SCENE and the option --set that run, check and explain share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "weft/estimate.h"
#include "weft/simulation.h"

namespace weft::cli {

struct SceneArgument {
  std::string scene;              // a path or a shipped scene's name
  std::vector<std::string> sets;  // POINTER=VALUE
};

void add_scene_argument(CLI::App& command, SceneArgument& argument);

struct LoadedScene {
  Scene scene;
  std::string path;                     // the file, as error lines name it
  std::vector<std::string> notes = {};  // on how it was read
};

// Reads and validates; throws a Failure that lists every fault.
LoadedScene load(const SceneArgument& argument);

// What it needs to run. Throws Failure where a simulation refuses the scene.
Estimate needs_of(const LoadedScene& loaded);

// Builds the simulation; faults of the scene or of the options, and too little memory, become a
// Failure.
Simulation simulate(const LoadedScene& loaded, const Options& options);

}  // namespace weft::cli
