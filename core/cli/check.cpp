// `weft check SCENE`: reads and validates only, and says what a run would need.
#include <iostream>
#include <memory>

#include "commands.h"
#include "failure.h"
#include "needs.h"
#include "scene_argument.h"
#include "weft/printable.h"

namespace weft::cli {

namespace {

int check(const SceneArgument& argument) {
  const LoadedScene loaded = load(argument);
  const Estimate needed = needs_of(loaded);
  std::cout << printable(loaded.path) << ": ok, " << needed.particles << " particles\n"
            << needs_words(needed);
  for (const std::string& note : loaded.notes) std::cout << "note: " << printable(note) << "\n";
  return kDone;
}

}  // namespace

void add_check(CLI::App& program, int& exit_code) {
  CLI::App* command = program.add_subcommand(
      "check", "Read and validate a scene; list every fault, or what a run needs");
  const auto argument = std::make_shared<SceneArgument>();
  add_scene_argument(*command, *argument);
  command->callback([argument, &exit_code] { exit_code = check(*argument); });
}

}  // namespace weft::cli
