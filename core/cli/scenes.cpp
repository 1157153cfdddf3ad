// `weft scenes`: the shipped scenes, one line each.
#include <algorithm>
#include <iomanip>
#include <iostream>

#include "commands.h"
#include "failure.h"
#include "weft/printable.h"
#include "weft/read_scene.h"

namespace weft::cli {

namespace {

int scenes() {
  const std::vector<ShippedScene> shipped = shipped_scenes();
  if (shipped.empty()) {
    throw Failure{kBadScene, {{"scenes", "none found", "WEFT_SCENES may name their folder"}}};
  }
  std::size_t width = 0;
  for (const ShippedScene& scene : shipped) width = std::max(width, printable(scene.name).size());
  for (const ShippedScene& scene : shipped) {
    std::cout << std::left << std::setw(static_cast<int>(width) + 2) << printable(scene.name)
              << scene.about << "\n";
  }
  return kDone;
}

}  // namespace

void add_scenes(CLI::App& program, int& exit_code) {
  CLI::App* command = program.add_subcommand("scenes", "List the scenes that ship with Weft");
  command->callback([&exit_code] { exit_code = scenes(); });
}

}  // namespace weft::cli
