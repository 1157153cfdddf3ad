// Rows turned into lanes and back (transpose.h), in tiles of 4 by 4.
#include "physics/kernels/transpose.h"

#include "physics/kernels/quarters.h"
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

#if WEFT_LANES == 16

// Four columns of 16 rows, there and back: rows r, r+4, r+8 and r+12 share a vector.
WEFT_INLINE void columns_to_lanes(const TransposeRows& t, int i) {
  Wide v[4];
  for (int r = 0; r < 4; ++r)
    v[r] = join_quarters([&](int n) { return load_four(t.rows + (r + n) * t.stride + i); });
  turn(v);
  for (int c = 0; c < 4; ++c) store(t.lanes + (i + c) * t.pitch, v[c]);
}
WEFT_INLINE void lanes_to_columns(const TransposeRows& t, int i) {
  Wide v[4];
  for (int c = 0; c < 4; ++c) v[c] = load(t.lanes + (i + c) * t.pitch);
  turn(v);
  for (int r = 0; r < 4; ++r)
    for_each_quarter(v[r], [&](int n, Four four) { put(t, (r + n) * t.stride + i, four); });
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
      Four v[4];
      for (int n = 0; n < 4; ++n) v[n] = load_four(t.rows + (r + n) * t.stride + i);
      turn(v);
      for (int n = 0; n < 4; ++n) store_four(t.lanes + (i + n) * t.pitch + r, v[n]);
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
      Four v[4];
      for (int n = 0; n < 4; ++n) v[n] = load_four(t.lanes + (i + n) * t.pitch + r);
      turn(v);
      for (int n = 0; n < 4; ++n) put(t, (r + n) * t.stride + i, v[n]);
    }
  for (int r = 0; r < t.row_count; ++r)
    for (int i = r < rows ? columns : 0; i < t.columns; ++i)
      put(t, r * t.stride + i, t.lanes[i * t.pitch + r]);
}

}  // namespace weft::WEFT_KERNELS
