// Overrides as `weft run --set POINTER=VALUE` takes them, one a line, of a scene with everything that
// pointers can lead to.
#include <sstream>

#include "target.h"
#include "weft/read_scene.h"

namespace {

constexpr std::string_view kScene =
    R"({"weft": 1, "cloths": [{"grid": {"points": [3, 3]}, "pins": [[0, 0], {"at": [1, 0], "keys": [[0, 0, 0, 0]]}]}],
        "colliders": [{"sphere": {"radius": 0.2}, "friction": 0.3, "keys": [[0, 0, 0, 0]]}], "wind": {"drag": 1}})";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<weft::Override> overrides;
  std::istringstream lines{std::string(fuzz::text_of(data, size))};
  for (std::string line; overrides.size() < 8 && std::getline(lines, line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos) continue;
    overrides.push_back({line.substr(0, equals), line.substr(equals + 1)});
  }
  const weft::SceneFile file = weft::read_scene_text(kScene, overrides);
  for (const weft::Fault& fault : file.faults) fuzz::require(!fault.what.empty());
  if (file.faults.empty()) fuzz::require(weft::validate(file.scene).empty());
  return 0;
}
