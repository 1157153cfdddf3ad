// Scene text: a clean answer to any bytes; what reads without fault is valid, and reads the same again
// as it is written.
#include "target.h"
#include "weft/read_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const weft::SceneFile file = weft::read_scene_text(fuzz::text_of(data, size));
  for (const weft::Fault& fault : file.faults) fuzz::require(!fault.what.empty());
  if (!file.faults.empty()) return 0;
  for (const weft::Fault& fault : weft::validate(file.scene))
    fuzz::require(fault.what == "the mesh is not read");
  const weft::SceneFile again = weft::read_scene_text(weft::write_scene_text(file.scene));
  fuzz::require(again.faults.empty() && again.scene == file.scene);
  return 0;
}
