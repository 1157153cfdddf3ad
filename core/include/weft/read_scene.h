// Text -> Scene. Reads both kinds of scene file (docs/scenes.md): course scenes (`cloth`, `sphere`,
// `plane`) and Weft scenes ("weft": 1), told apart by their keys.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "weft/scene.h"

namespace weft {

// One override of a scene value: `/solver/iterations=20`. The value is JSON; a bare word is a string.
// What the file leaves out on the way there is filled in with its defaults; an index one past the
// end of a list appends. In a course scene, pointers below /cloth, /sphere and /plane change the
// file's own values, all others the Weft scene that it means.
struct Override {
  std::string pointer;
  std::string value;
};

struct SceneFile {
  Scene scene;                // complete only when `faults` is empty
  std::string path;           // the file it came from; "" for text
  std::vector<Fault> faults;  // all that is wrong (the first 100): values in the order of the file,
                              // then what does not fit together
  std::vector<std::string> notes;  // of a course file: what is ignored or read otherwise than it is
                                   // written, a sentence each that begins with its place
  bool found = true;               // false: no such file and no shipped scene of that name
};

struct ShippedScene {
  std::string name;   // "pinned2"
  std::string path;   // the file
  std::string about;  // its one-line description
};

// Reads a scene from a path or by the name of a shipped scene. Never throws on bad input: what is
// wrong is in `faults`.
SceneFile read_scene(const std::string& path_or_name, const std::vector<Override>& overrides = {});

// The same from text in memory. No other file is read: meshes are left to load_meshes() (weft/mesh.h).
SceneFile read_scene_text(std::string_view json, const std::vector<Override>& overrides = {});

// The scene as a Weft scene file, such that reading it gives the same scene.
std::string write_scene_text(const Scene& scene);

// The shipped scenes in alphabetical order. They are looked for in $WEFT_SCENES, then beside the
// program as installed, then in the source tree that the library was built from, then where the
// library was installed.
std::vector<ShippedScene> shipped_scenes();

// The JSON Schema of Weft scenes, as text: names, ranges, defaults, units, one help line per value.
std::string_view scene_schema();

}  // namespace weft
