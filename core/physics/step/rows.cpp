// Rows of particles (rows.h).
#include "physics/step/rows.h"

namespace weft::physics {

int row_stride(int columns) {
  const int stride = (columns + 15) / 16 * 16 + 16;
  return stride % 256 == 0 ? stride + 16 : stride;
}

Rows::Rows(int rows, int stride)
    : rows_(rows),
      stride_(stride),
      // Components 80 floats further apart than their size, so that they do not share cache sets.
      plane_(static_cast<std::size_t>(rows) * stride + 80),
      data_(3 * plane_) {
  assert(stride % 16 == 0);  // kernels work on whole groups of 16 lanes, aligned
}

}  // namespace weft::physics
