// `weft explain SCENE`: the step plan, with what was left out and why, and what a run needs.
#include <iostream>
#include <memory>

#include "commands.h"
#include "failure.h"
#include "needs.h"
#include "scene_argument.h"
#include "weft/printable.h"

namespace weft::cli {

namespace {

int explain(const SceneArgument& argument) {
  const LoadedScene loaded = load(argument);
  Options options;
  options.threads = 1;
  const Simulation simulation = simulate(loaded, options);
  std::cout << printable(loaded.scene.name.empty() ? loaded.path : loaded.scene.name) << ": "
            << to_text(simulation.plan()) << needs_words(estimate(simulation));
  for (const std::string& note : loaded.notes) std::cout << "note: " << printable(note) << "\n";
  return kDone;
}

}  // namespace

void add_explain(CLI::App& program, int& exit_code) {
  CLI::App* command =
      program.add_subcommand("explain", "Print what one frame of a scene does, stage by stage");
  const auto argument = std::make_shared<SceneArgument>();
  add_scene_argument(*command, *argument);
  command->callback([argument, &exit_code] { exit_code = explain(*argument); });
}

}  // namespace weft::cli
