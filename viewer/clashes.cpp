// The viewer's options for files.
#include "clashes.h"

#include <filesystem>

#include "failure.h"
#include "weft/output.h"
#include "weft/printable.h"

namespace weft::viewer {

void refuse_clashes(const Arguments& arguments, const std::string& scene) {
  const PictureFiles& pictures = arguments.pictures;
  std::vector<NamedFile> outputs, inputs{{"SCENE", scene},
                                         {"--keys", arguments.keys},
                                         {"--texture", pictures.texture},
                                         {"--height-map", pictures.height_map},
                                         {"--base-color-map", pictures.material[0]},
                                         {"--metallic-map", pictures.material[1]},
                                         {"--roughness-map", pictures.material[2]},
                                         {"--normal-map", pictures.material[3]},
                                         {"standard output", "/dev/stdout"},
                                         {"standard error", "/dev/stderr"}};
  std::error_code error;
  if (!pictures.sky.empty())
    for (std::filesystem::directory_iterator entry(pictures.sky, error), end;
         !error && entry != end; entry.increment(error))
      inputs.push_back({"--sky", entry->path().string()});
  std::erase_if(inputs, [](const NamedFile& file) { return file.path.empty(); });
  for (const NamedFile& file : {NamedFile{"--record", arguments.record},
                                {"--log", arguments.log},
                                {"--out", arguments.out}})
    if (!file.path.empty()) outputs.push_back(file);
  if (const std::optional<Fault> fault = find_clash(outputs, inputs))
    throw Failure(kBadCommandLine,
                  printable(fault->place) + ": " + fault->what + " (" + fault->allowed + ")");
}

}  // namespace weft::viewer
