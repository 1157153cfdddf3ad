// The triangles of a grid.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace weft {

// Two of every square, corners numbered from `first` on, row by row.
inline void add_squares(int columns, int rows, std::int32_t first,
                        std::vector<std::array<std::int32_t, 3>>& faces) {
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) {
      const std::int32_t p = first + j * columns + i;
      faces.push_back({p, p + 1, p + columns});
      faces.push_back({p + 1, p + columns + 1, p + columns});
    }
}

}  // namespace weft
