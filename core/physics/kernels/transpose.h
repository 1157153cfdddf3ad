// Rows as lanes: what the kernels take that turn them there and back (transpose.cpp), so that whole
// rows can be solved side by side.
#pragma once

#include <cstddef>

namespace weft::physics {

// 16 neighbouring rows of one array as 16 neighbouring lanes, or back: element (row r, column i) is
// rows[r*stride + i] and lanes[i*pitch + r].
struct TransposeRows {
  float* rows;
  std::ptrdiff_t stride;
  float* lanes;
  std::ptrdiff_t pitch;
  // lanes_to_rows: not null, then lanes are added to the rows, and `rate` times them to these, laid out
  // as the rows; else the rows take what the lanes hold.
  float* rates;
  float rate;
  int row_count;  // 1 … 16; rows past it are left alone, their lanes hold values of no meaning
  int columns;
};

// Columns of lanes that rows_to_lanes may write, for so many columns: whole tiles. It reads as many of
// the rows.
inline constexpr int turned_columns(int columns) {
  return (columns + 7) / 8 * 8;
}

}  // namespace weft::physics
