// The triangles of a whole sheet, by the numbers of its particles.
#pragma once

#include <cstdint>
#include <vector>

namespace weft {

// Appends three corners for each of the two triangles of every square of a grid (weft/view.h) whose
// particles have the numbers `first` and up.
inline void append_triangles(std::uint32_t columns, std::uint32_t rows, std::uint32_t first,
                             std::vector<std::uint32_t>& all) {
  for (std::uint32_t j = 0; j + 1 < rows; ++j)
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t a = first + j * columns + i, b = a + 1, c = a + columns, d = c + 1;
      for (const std::uint32_t corner : {a, b, c, b, d, c}) all.push_back(corner);
    }
}

}  // namespace weft
