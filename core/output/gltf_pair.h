// A .gltf and the .bin beside it, replaced so that the one always matches the other: whoever reads
// them, or kills the process, at any moment has both old or both new.
//
// No file system replaces two files at once. Where there is a .gltf already, the new buffer first
// stands beside the old one as NAME.weft-new.bin, and a .gltf that refers to it takes the name; only
// then is NAME.bin free to be replaced, a .gltf that refers to that takes the name, and the other
// buffer goes. A process killed in between leaves NAME.weft-new.bin to the next export of that name.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "weft/output.h"

namespace weft {

class GltfPair {
 public:
  // Throws WriteError, as all of it.
  explicit GltfPair(const std::string& path);

  OutputFile& buffer() { return buffer_; }
  // The buffer is written; `document` gives the .gltf for the URI of the buffer.
  void complete(const std::function<std::string(const std::string& uri)>& document);
  void commit();
  std::string written() const { return json_.path() + ", " + buffer_.path(); }

  // All names that it uses.
  static std::vector<std::string> names(const std::string& path);

 private:
  OutputFile json_, buffer_;
  std::optional<OutputFile> passing_json_, passing_buffer_;
};

}  // namespace weft
