// The animation formats, one file each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "weft/output.h"

namespace weft {

// The extension of a file name in small letters: ".pc2".
std::string extension_of(const std::string& path);

// Particles of one cloth, and of all.
std::int64_t particle_count(const ClothView& cloth);
std::int64_t particle_count(const View& view);

// A position where it stands.
inline std::array<float, 3> placed(const View& view, float x, float y, float z) {
  return {static_cast<float>(x + view.origin[0]), static_cast<float>(y + view.origin[1]),
          static_cast<float>(z + view.origin[2])};
}

// Calls work(x, y, z) for the particles of a cloth in scene order, from the view's origin.
template <class Work>
void for_each_particle(const ClothView& cloth, const Work& work) {
  for (const std::uint32_t n : cloth.lanes) work(cloth.x[n], cloth.y[n], cloth.z[n]);
  for (int j = 0; cloth.lanes.empty() && j < cloth.rows; ++j)
    for (int i = 0; i < cloth.columns; ++i) {
      const auto n = static_cast<std::size_t>(j) * static_cast<std::size_t>(cloth.stride) +
                     static_cast<std::size_t>(i);
      work(cloth.x[n], cloth.y[n], cloth.z[n]);
    }
}
// Calls work(position) for all particles, where they stand.
template <class Work>
void for_each_placed(const View& view, const Work& work) {
  for (const ClothView& cloth : view.cloths)
    for_each_particle(cloth, [&](float x, float y, float z) { work(placed(view, x, y, z)); });
}

// `samples` are to come, 0: nobody knows.
std::unique_ptr<Animation> open_pc2(const std::string& path, const View& first,
                                    std::int64_t samples);
std::unique_ptr<Animation> open_mdd(const std::string& path, const View& first,
                                    std::int64_t samples);
std::unique_ptr<Animation> open_gltf(const std::string& path, const View& first,
                                     std::int64_t samples);
std::unique_ptr<Animation> open_usda(const std::string& path, const View& first,
                                     std::int64_t samples);
std::unique_ptr<Animation> open_obj_sequence(const std::string& path, const View& first,
                                             std::int64_t samples);

}  // namespace weft
