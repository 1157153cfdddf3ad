// Mesh files of all kinds, told apart by the ends of their names.
#include "scene/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "scene/mesh/faces.h"

namespace weft {
namespace {

// Whether a name ends so, in letters of any size.
bool ends_in(std::string_view path, std::string_view end) {
  return path.size() >= end.size() &&
         std::equal(end.begin(), end.end(), path.end() - std::ptrdiff_t(end.size()),
                    [](char small, char c) {
                      return c == small || (c >= 'A' && c <= 'Z' && c - 'A' + 'a' == small);
                    });
}

// By the mark that such text begins with.
bool is_utf16(std::string_view bytes) {
  return bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF");
}

constexpr std::array<std::string_view, 4> kEnds{".obj", ".ply", ".glb", ".gltf"};

}  // namespace

text::FileBytes text::bytes_of_file(const std::string& path, std::size_t most) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return {{}, "there is no such mesh file", "a readable file"};
  FileBytes file;
  std::string some(1 << 16, '\0');
  while (in.read(some.data(), std::streamsize(some.size())), in.gcount() > 0) {
    file.bytes.append(some, 0, std::size_t(in.gcount()));
    if (file.bytes.size() > most) return {{}, "the file is larger", "at most 1 GiB"};
  }
  if (in.bad() || !in.eof()) return {{}, "the file cannot be read", "a readable file"};
  return file;
}

bool text::is_gltf_file(std::string_view path) {
  return ends_in(path, ".glb") || ends_in(path, ".gltf");
}

bool is_mesh_file(std::string_view path) {
  return std::any_of(kEnds.begin(), kEnds.end(),
                     [&](std::string_view end) { return ends_in(path, end); });
}

MeshFile read_mesh(const std::string& path) {
  MeshFile file;
  const auto refuse = [&](const char* what, const char* allowed) {
    file.faults.push_back({path, what, allowed});
    return file;
  };
  if (!is_mesh_file(path)) return refuse("the file is of no known kind", ".obj, .ply, .glb, .gltf");
  const text::FileBytes read = text::bytes_of_file(path, text::kMaxMeshBytes);
  if (read.fault) return refuse(read.fault, read.allowed);
  if (is_utf16(read.bytes)) return refuse("the file is text in UTF-16", "UTF-8 or ASCII");
  if (ends_in(path, ".obj")) return read_obj(read.bytes, path);
  if (ends_in(path, ".ply")) return read_ply(read.bytes, path);
  return read_gltf(read.bytes, path, std::filesystem::path(path).parent_path().string());
}

}  // namespace weft
