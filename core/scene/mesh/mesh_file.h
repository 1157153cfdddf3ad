// Bytes of files that meshes are read from.
#pragma once

#include <string>
#include <string_view>

namespace weft::text {

// What is wrong where a scene has a mesh without a file, and what belongs there.
inline constexpr const char *kNoMeshFile = "file is missing",
                            *kMeshFiles = "a mesh file (.obj, .ply, .glb, .gltf)";

// The bytes of a file that may be as long as `most`; else `fault` says why there are none, and `allowed`.
struct FileBytes {
  std::string bytes;
  const char *fault = nullptr, *allowed = nullptr;
};
FileBytes bytes_of_file(const std::string& path, std::size_t most);

// Whether a file's name ends in .glb or .gltf, in letters of any size.
bool is_gltf_file(std::string_view path);

}  // namespace weft::text
