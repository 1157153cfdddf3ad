// Rows turned into lanes and back (transpose.h), in tiles of 4 by 4.
#include "physics/kernels/transpose.h"

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

using physics::TransposeRows;

// What lanes_to_rows does with neighbouring columns of a row.
template <class T>
WEFT_INLINE void put(const TransposeRows& t, std::ptrdiff_t at, T value) {
  typedef T Loose __attribute__((aligned(4), may_alias));
  auto* to = reinterpret_cast<Loose*>(t.rows + at);
  if (!t.rates) {
    *to = value;
    return;
  }
  auto* rate = reinterpret_cast<Loose*>(t.rates + at);
  *to = *to + value;
  *rate = *rate + value * t.rate;
}

typedef float Quad __attribute__((vector_size(16)));
typedef Quad QuadLoose __attribute__((aligned(4), may_alias));

// A 4 by 4 tile.
WEFT_INLINE void transpose4(Quad (&v)[4]) {
  const auto low = [](Quad a, Quad b) { return __builtin_shufflevector(a, b, 0, 4, 1, 5); };
  const auto high = [](Quad a, Quad b) { return __builtin_shufflevector(a, b, 2, 6, 3, 7); };
  const Quad a = low(v[0], v[1]), b = high(v[0], v[1]), c = low(v[2], v[3]), d = high(v[2], v[3]);
  v[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  v[1] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  v[2] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  v[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}
WEFT_INLINE Quad& quad(float* p) {
  return *reinterpret_cast<QuadLoose*>(p);
}

#if WEFT_LANES == 16

// Four 16-lane vectors whose quarters are 4 by 4 tiles, each tile transposed.
WEFT_INLINE void transpose_quarters(Wide (&v)[4]) {
  const auto low = [](Wide a, Wide b) {
    return __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
  };
  const auto high = [](Wide a, Wide b) {
    return __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15,
                                   31);
  };
  const auto low_pairs = [](Wide a, Wide b) {
    return __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
  };
  const auto high_pairs = [](Wide a, Wide b) {
    return __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30,
                                   31);
  };
  const Wide a = low(v[0], v[1]), b = high(v[0], v[1]), c = low(v[2], v[3]), d = high(v[2], v[3]);
  v[0] = low_pairs(a, c);
  v[1] = high_pairs(a, c);
  v[2] = low_pairs(b, d);
  v[3] = high_pairs(b, d);
}

// Four columns of 16 rows, there and back: rows r, r+4, r+8 and r+12 share a vector.
WEFT_INLINE void columns_to_lanes(const TransposeRows& t, int i) {
  Wide v[4];
  for (int r = 0; r < 4; ++r) {
    const auto row = [&](int n) -> Quad { return quad(t.rows + n * t.stride + i); };
    const auto ab = __builtin_shufflevector(row(r), row(r + 4), 0, 1, 2, 3, 4, 5, 6, 7);
    const auto cd = __builtin_shufflevector(row(r + 8), row(r + 12), 0, 1, 2, 3, 4, 5, 6, 7);
    v[r] = __builtin_shufflevector(ab, cd, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  }
  transpose_quarters(v);
  for (int c = 0; c < 4; ++c) store(t.lanes + (i + c) * t.pitch, v[c]);
}
WEFT_INLINE void lanes_to_columns(const TransposeRows& t, int i) {
  Wide v[4];
  for (int c = 0; c < 4; ++c) v[c] = load(t.lanes + (i + c) * t.pitch);
  transpose_quarters(v);
  for (int r = 0; r < 4; ++r) {
    const Quad quads[4] = {__builtin_shufflevector(v[r], v[r], 0, 1, 2, 3),
                           __builtin_shufflevector(v[r], v[r], 4, 5, 6, 7),
                           __builtin_shufflevector(v[r], v[r], 8, 9, 10, 11),
                           __builtin_shufflevector(v[r], v[r], 12, 13, 14, 15)};
    for (int q = 0; q < 4; ++q) put(t, (r + 4 * q) * t.stride + i, quads[q]);
  }
}

#endif

}  // namespace

void rows_to_lanes(const TransposeRows& t) {
#if WEFT_LANES == 16
  if (t.row_count == 16) {  // reads the padding of the last columns
    for (int i = 0; i < t.columns; i += 4) columns_to_lanes(t, i);
    return;
  }
#endif
  const int whole = t.row_count & ~3;
  for (int i = 0; i < t.columns; i += 4)
    for (int r = 0; r < whole; r += 4) {
      Quad v[4];
      for (int n = 0; n < 4; ++n) v[n] = quad(t.rows + (r + n) * t.stride + i);
      transpose4(v);
      for (int n = 0; n < 4; ++n) quad(t.lanes + (i + n) * t.pitch + r) = v[n];
    }
  for (int r = whole; r < t.row_count; ++r)
    for (int i = 0; i < t.columns; ++i) t.lanes[i * t.pitch + r] = t.rows[r * t.stride + i];
}

void lanes_to_rows(const TransposeRows& t) {
  const int rows = t.row_count & ~3, columns = t.columns & ~3;
#if WEFT_LANES == 16
  if (t.row_count == 16)
    for (int i = 0; i < columns; i += 4) lanes_to_columns(t, i);
#endif
  for (int i = 0; i < columns && (kLanes < 16 || t.row_count < 16); i += 4)
    for (int r = 0; r < rows; r += 4) {
      Quad v[4];
      for (int n = 0; n < 4; ++n) v[n] = quad(t.lanes + (i + n) * t.pitch + r);
      transpose4(v);
      for (int n = 0; n < 4; ++n) put(t, (r + n) * t.stride + i, v[n]);
    }
  for (int r = 0; r < t.row_count; ++r)
    for (int i = r < rows ? columns : 0; i < t.columns; ++i)
      put(t, r * t.stride + i, t.lanes[i * t.pitch + r]);
}

}  // namespace weft::WEFT_KERNELS
