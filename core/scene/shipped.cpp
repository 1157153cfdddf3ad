#include "scene/shipped.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "scene/assets.h"
#include "weft/read_scene.h"

namespace weft {
namespace text {
namespace {

namespace fs = std::filesystem;

// The first folder that is there: the user's, beside the program as installed, in the source tree,
// where the library was installed. The source tree first, so that what is being worked on is not
// hidden by an older version on the same machine.
fs::path scene_folder() {
  std::error_code ignored;  // a folder that cannot be looked at is not there
  if (const char* chosen = std::getenv("WEFT_SCENES"))
    if (fs::is_directory(chosen, ignored)) return chosen;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  for (const fs::path& folder : {program.parent_path().parent_path() / "share/weft/scenes",
                                 fs::path(kSourceScenes), fs::path(kInstalledScenes)})
    if (fs::is_directory(folder, ignored)) return folder;
  return {};
}

}  // namespace

std::string shipped_path(const std::string& name) {
  std::error_code ignored;
  const fs::path file = scene_folder() / (name + ".json");
  return fs::is_regular_file(file, ignored) ? file.string() : "";
}

}  // namespace text

std::vector<ShippedScene> shipped_scenes() {
  std::vector<ShippedScene> scenes;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(text::scene_folder(), error), end;
       !error && entry != end; entry.increment(error)) {
    const std::filesystem::path& path = entry->path();
    if (path.extension() != ".json") continue;
    scenes.push_back({path.stem().string(), path.string(), read_scene(path.string()).scene.about});
  }
  std::sort(scenes.begin(), scenes.end(),
            [](const ShippedScene& a, const ShippedScene& b) { return a.name < b.name; });
  return scenes;
}

}  // namespace weft
