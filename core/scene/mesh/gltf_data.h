// The numbers of a glTF document: accessors, through views of buffers, which are a part of the .glb, text in the
// document, or files beside it.
#pragma once

#include <array>

#include "scene/mesh/gltf_value.h"

namespace weft::text {

class GltfData {
 public:
  // `binary`: of a .glb, the data that follows the document; `folder`: of the file.
  GltfData(const GltfValue& document, std::optional<std::string_view> binary, std::string folder);

  // How many elements the accessor has; refused above `most`.
  std::size_t count(std::size_t accessor, std::size_t most) const;
  // The numbers of an accessor, element after element, each of `type` ("SCALAR", "VEC2", "VEC3", "VEC4", or "MAT4",
  // column after column); normalised integers as what they stand for, sparse ones in full. Refused: another type,
  // what is not finite, what lies outside of its buffer, more than 2^28 numbers of all that is read.
  std::vector<double> numbers(std::size_t accessor, const char* type);

 private:
  struct Span {
    std::string_view bytes;  // from the first element on
    std::size_t stride;
  };
  GltfValue accessor(std::size_t n) const;
  Span span_of(const GltfValue& accessor, std::size_t count, std::size_t element);
  std::string_view buffer(std::size_t n);
  std::string load(const GltfValue& buffer, const std::string& uri);

  GltfValue document_;
  std::optional<std::string_view> binary_;
  std::string folder_;
  std::vector<std::optional<std::string>> loaded_;  // buffers
  std::size_t loaded_bytes_ = 0;
  std::size_t numbers_ = 0;  // read
};

}  // namespace weft::text
