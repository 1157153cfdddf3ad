// The header of a .ply file: which elements follow it, and what each consists of.
#pragma once

#include <bit>
#include <optional>

#include "scene/mesh/faces.h"

namespace weft::text {

struct PlyType {
  int bytes = 0;
  bool real = false, is_signed = false;
};

struct PlyProperty {
  std::string name;
  PlyType type;                  // of each value
  std::optional<PlyType> count;  // of a list: of how many values it has
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;  // rows
  std::vector<PlyProperty> properties;

  int find(std::string_view property) const;  // its place among them, -1: not there
};

struct PlyHeader {
  bool ascii = true;
  std::endian order = std::endian::little;  // of numbers, unless in text
  std::vector<PlyElement> elements;         // as they follow
  std::size_t bytes = 0;                    // of the header itself
  int lines = 0;
};

// Reads the header; what is wrong becomes a fault, with its line.
PlyHeader read_ply_header(std::string_view bytes, RawMesh& raw);

}  // namespace weft::text
