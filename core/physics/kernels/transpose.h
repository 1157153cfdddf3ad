// Rows as lanes: what the kernels take that turn them there and back (transpose.cpp), so that whole
// rows can be solved side by side.
#pragma once

#include <cstddef>

namespace weft::physics {

// 16 neighbouring rows of one array as 16 neighbouring lanes, or back: element (row r, column i) is
// rows[r*stride + i] and lanes[i*pitch + r]. rows_to_lanes sets lanes, lanes_to_rows adds to rows.
struct TransposeRows {
  float* rows;
  const float* added;  // rows_to_lanes: what lanes have besides, laid out as the rows; or null
  std::ptrdiff_t stride;
  float* lanes;
  std::ptrdiff_t pitch;
  int row_count;  // 1 … 16; rows past it are left alone, their lanes hold values of no meaning
  int columns;
};

// Columns of lanes that rows_to_lanes may write, for so many columns: whole tiles. It reads as many of
// the rows.
inline constexpr int turned_columns(int columns) {
  return (columns + 7) / 8 * 8;
}

}  // namespace weft::physics
