// `weft check SCENE`: reads and validates only.
#include <cstdint>
#include <iostream>
#include <memory>

#include "commands.h"
#include "failure.h"
#include "output/printable.h"
#include "scene_argument.h"

namespace weft::cli {

namespace {

int check(const SceneArgument& argument) {
  const LoadedScene loaded = load(argument);
  std::int64_t particles = 0;
  for (const Cloth& cloth : loaded.scene.cloths) {
    particles += static_cast<std::int64_t>(cloth.grid.nx) * cloth.grid.ny;
  }
  std::cout << printable(loaded.path) << ": ok, " << particles << " particles\n";
  return kDone;
}

}  // namespace

void add_check(CLI::App& program, int& exit_code) {
  CLI::App* command =
      program.add_subcommand("check", "Read and validate a scene; list every fault");
  const auto argument = std::make_shared<SceneArgument>();
  add_scene_argument(*command, *argument);
  command->callback([argument, &exit_code] { exit_code = check(*argument); });
}

}  // namespace weft::cli
