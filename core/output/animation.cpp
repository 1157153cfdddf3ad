// Picks an animation format by extension. A new format adds its file and one line to kFormats.
#include "output/animation.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

namespace weft {

namespace {

struct Format {
  const char* extension;
  std::unique_ptr<Animation> (*open)(const std::string& path, const View& first,
                                     std::int64_t samples);
};

constexpr std::array<Format, 6> kFormats{{
    {".pc2", open_pc2},
    {".mdd", open_mdd},
    {".obj", open_obj_sequence},
    {".gltf", open_gltf},
    {".glb", open_gltf},
    {".usda", open_usda},
}};

}  // namespace

std::vector<std::string> animation_extensions() {
  std::vector<std::string> extensions;
  extensions.reserve(kFormats.size());
  for (const Format& format : kFormats) extensions.emplace_back(format.extension);
  return extensions;
}

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void Animation::finish() {
  complete();
  commit();
}

std::int64_t particle_count(const ClothView& cloth) {
  if (!cloth.lanes.empty()) return static_cast<std::int64_t>(cloth.lanes.size());
  return static_cast<std::int64_t>(cloth.columns) * cloth.rows;
}

std::int64_t particle_count(const View& view) {
  std::int64_t count = 0;
  for (const ClothView& cloth : view.cloths) count += particle_count(cloth);
  return count;
}

std::unique_ptr<Animation> open_animation(const std::string& path, const View& first,
                                          std::int64_t samples) {
  const std::string extension = extension_of(path);
  for (const Format& format : kFormats) {
    if (extension == format.extension) return format.open(path, first, samples);
  }
  throw std::invalid_argument("'" + extension + "' is not an animation format");
}

}  // namespace weft
