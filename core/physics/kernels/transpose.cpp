// Rows turned into lanes and back (transpose.h), in tiles of 4 by 4.
#include "physics/kernels/transpose.h"

#include "physics/kernels/quarters.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

using physics::TransposeRows;

// Neighbouring columns of a row.
template <class T>
WEFT_INLINE void add(const TransposeRows& t, std::ptrdiff_t at, T value) {
  typedef T Loose __attribute__((aligned(4), may_alias));
  auto* to = reinterpret_cast<Loose*>(t.rows + at);
  *to = *to + value;
}

#if WEFT_LANES == 16

// Eight columns of 16 rows, there and back: memory moves eight floats at a time, and in between rows r,
// r+4, r+8 and r+12 share a vector, one for the first four columns and one for the others.
typedef float Eight __attribute__((vector_size(32), may_alias));

WEFT_INLINE Wide join_halves(const float* a, const float* b) {
  return (Wide)_mm512_insertf32x8(_mm512_castps256_ps512(_mm256_loadu_ps(a)), _mm256_loadu_ps(b),
                                  1);
}
// Eight columns of a row and of the fourth after it.
WEFT_INLINE Wide two_rows(const TransposeRows& t, std::ptrdiff_t at) {
  const std::ptrdiff_t fourth = at + 4 * t.stride;
  const Wide rows = join_halves(t.rows + at, t.rows + fourth);
  return t.added ? rows + join_halves(t.added + at, t.added + fourth) : rows;
}
template <int Half>
WEFT_INLINE Eight half(Wide v) {
  constexpr int l = 8 * Half;
  return __builtin_shufflevector(v, v, l, l + 1, l + 2, l + 3, l + 4, l + 5, l + 6, l + 7);
}
// Four of the quarters of a (0 … 3) and b (4 … 7).
template <int A, int B, int C, int D>
WEFT_INLINE Wide quarters(Wide a, Wide b) {
  constexpr int i = 4 * A, j = 4 * B, k = 4 * C, l = 4 * D;
  return __builtin_shufflevector(a, b, i, i + 1, i + 2, i + 3, j, j + 1, j + 2, j + 3,  //
                                 k, k + 1, k + 2, k + 3, l, l + 1, l + 2, l + 3);
}

WEFT_INLINE void columns_to_lanes(const TransposeRows& t, int i) {
  Wide first[4], second[4];
  for (int r = 0; r < 4; ++r) {
    const Wide a = two_rows(t, r * t.stride + i), b = two_rows(t, (r + 8) * t.stride + i);
    first[r] = quarters<0, 2, 4, 6>(a, b);
    second[r] = quarters<1, 3, 5, 7>(a, b);
  }
  turn(first);
  turn(second);
  for (int c = 0; c < 4; ++c) {
    store(t.lanes + (i + c) * t.pitch, first[c]);
    store(t.lanes + (i + c + 4) * t.pitch, second[c]);
  }
}

// Eight columns of two rows.
WEFT_INLINE void put_halves(const TransposeRows& t, int row, int i, Wide v) {
  add(t, row * t.stride + i, half<0>(v));
  add(t, (row + 4) * t.stride + i, half<1>(v));
}
WEFT_INLINE void lanes_to_columns(const TransposeRows& t, int i) {
  Wide first[4], second[4];
  for (int c = 0; c < 4; ++c) {
    first[c] = load(t.lanes + (i + c) * t.pitch);
    second[c] = load(t.lanes + (i + c + 4) * t.pitch);
  }
  turn(first);
  turn(second);
  for (int r = 0; r < 4; ++r) {
    put_halves(t, r, i, quarters<0, 4, 1, 5>(first[r], second[r]));
    put_halves(t, r + 8, i, quarters<2, 6, 3, 7>(first[r], second[r]));
  }
}

#endif

}  // namespace

void rows_to_lanes(const TransposeRows& t) {
#if WEFT_LANES == 16
  if (t.row_count == 16) {  // reads the padding of the last columns
    for (int i = 0; i < t.columns; i += 8) columns_to_lanes(t, i);
    return;
  }
#endif
  const int whole = t.row_count & ~3;
  for (int i = 0; i < t.columns; i += 4)
    for (int r = 0; r < whole; r += 4) {
      Four v[4];
      for (int n = 0; n < 4; ++n) {
        const std::ptrdiff_t at = (r + n) * t.stride + i;
        v[n] = load_four(t.rows + at);
        if (t.added) v[n] = v[n] + load_four(t.added + at);
      }
      turn(v);
      for (int n = 0; n < 4; ++n) store_four(t.lanes + (i + n) * t.pitch + r, v[n]);
    }
  for (int r = whole; r < t.row_count; ++r)
    for (int i = 0; i < t.columns; ++i) {
      const std::ptrdiff_t at = r * t.stride + i;
      t.lanes[i * t.pitch + r] = t.added ? t.rows[at] + t.added[at] : t.rows[at];
    }
}

void lanes_to_rows(const TransposeRows& t) {
  const int rows = t.row_count & ~3, columns = t.columns & ~3;
  int done = 0;
#if WEFT_LANES == 16
  if (t.row_count == 16)
    for (; done + 8 <= columns; done += 8) lanes_to_columns(t, done);
#endif
  for (int i = done; i < columns; i += 4)
    for (int r = 0; r < rows; r += 4) {
      Four v[4];
      for (int n = 0; n < 4; ++n) v[n] = load_four(t.lanes + (i + n) * t.pitch + r);
      turn(v);
      for (int n = 0; n < 4; ++n) add(t, (r + n) * t.stride + i, v[n]);
    }
  for (int r = 0; r < t.row_count; ++r)
    for (int i = r < rows ? columns : 0; i < t.columns; ++i)
      add(t, r * t.stride + i, t.lanes[i * t.pitch + r]);
}

}  // namespace weft::WEFT_KERNELS
