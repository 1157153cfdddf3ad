// Text of the command line -> a scene that can be simulated.
#include "scene_argument.h"

#include <new>
#include <utility>

#include "failure.h"
#include "needs.h"
#include "weft/read_scene.h"

namespace weft::cli {

namespace {

std::string fault_of_set(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || !text.starts_with('/')) {
    return "'" + text + "' is not POINTER=VALUE (such as /solver/iterations=20)";
  }
  return "";
}

// A fault's place within the scene becomes a place that names the file, too.
std::vector<Fault> in_file(const std::string& path, std::vector<Fault> faults) {
  for (Fault& fault : faults) fault.place = path + (fault.place.empty() ? "" : ":" + fault.place);
  return faults;
}

}  // namespace

void add_scene_argument(CLI::App& command, SceneArgument& argument) {
  command.add_option("SCENE", argument.scene, "A scene file, or the name of a shipped scene")
      ->required()
      ->type_name("");
  command
      .add_option("--set", argument.sets,
                  "Override one value of the scene, such as /solver/iterations=20; repeatable")
      ->type_name("POINTER=VALUE")
      ->allow_extra_args(false)
      ->check(CLI::Validator(fault_of_set, ""));
}

LoadedScene load(const SceneArgument& argument) {
  std::vector<Override> overrides;
  for (const std::string& set : argument.sets) {
    const std::size_t equals = set.find('=');
    overrides.push_back({set.substr(0, equals), set.substr(equals + 1)});
  }
  SceneFile file = read_scene(argument.scene, overrides);
  const std::string path = file.path.empty() ? argument.scene : file.path;
  if (!file.faults.empty()) throw Failure{kBadScene, in_file(path, std::move(file.faults))};
  return {std::move(file.scene), path, std::move(file.notes)};
}

Estimate needs_of(const LoadedScene& loaded) {
  try {
    return estimate(loaded.scene);
  } catch (const SceneError& error) {
    throw Failure{kBadScene, in_file(loaded.path, error.faults)};
  }
}

Simulation simulate(const LoadedScene& loaded, const Options& options) {
  try {
    require_memory(loaded.scene, loaded.path);
    return Simulation(loaded.scene, options);
  } catch (const std::bad_alloc&) {
    throw Failure{kStopped,
                  {{loaded.path,
                    "the scene needs about " + bytes_words(estimate(loaded.scene).bytes) +
                        " of memory, and the system gives no more",
                    ""}}};
  } catch (const SceneError& error) {
    throw Failure{kBadScene, in_file(loaded.path, error.faults)};
  } catch (const std::invalid_argument& error) {
    throw Failure{kBadCommandLine, {{"command line", error.what(), ""}}};
  }
}

}  // namespace weft::cli
