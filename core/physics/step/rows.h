// Rows of particles: separate component arrays (structure of arrays), each 64-byte aligned, each row padded
// by at least 16 lanes that kernels may read and overwrite.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>

#include "physics/kernels/kernels.h"
#include "physics/kernels/particles.h"
#include "physics/step/aligned_array.h"

namespace weft::physics {

// Floats from one row to the next for a given number of columns: a multiple of 16 with 16 lanes of
// padding at least, and never a multiple of 1 KiB, where neighbouring rows would compete for the
// same lines of the cache.
int row_stride(int columns);

// Three component arrays of `rows` rows.
class Rows {
 public:
  Rows() = default;
  Rows(int rows, int stride);
  Row3 row(int j) {
    assert(j >= 0 && j < rows_);
    float* base = data_.data() + static_cast<std::size_t>(j) * stride_;
    return {base, base + plane_, base + 2 * plane_};
  }
  ConstRow3 row(int j) const {
    assert(j >= 0 && j < rows_);
    const float* base = data_.data() + static_cast<std::size_t>(j) * stride_;
    return {base, base + plane_, base + 2 * plane_};
  }
  std::span<const float> component(int axis) const {
    return {data_.data() + axis * plane_, static_cast<std::size_t>(rows_) * stride_};
  }
  float& at(int axis, int j, int i) {
    assert(axis >= 0 && axis < 3 && j >= 0 && j < rows_ && i >= 0 && i < stride_);
    return data_[axis * plane_ + static_cast<std::size_t>(j) * stride_ + i];
  }
  float at(int axis, int j, int i) const {
    assert(axis >= 0 && axis < 3 && j >= 0 && j < rows_ && i >= 0 && i < stride_);
    return data_[axis * plane_ + static_cast<std::size_t>(j) * stride_ + i];
  }
  std::size_t bytes() const { return data_.size() * sizeof(float); }
  void clear() { std::fill_n(data_.data(), data_.size(), 0.0f); }
  // Takes over the values of rows of the same shape.
  void copy(const Rows& from) {
    assert(from.rows_ == rows_ && from.stride_ == stride_);
    std::copy_n(from.data_.data(), data_.size(), data_.data());
  }
  void scale(float factor) {
    for (std::size_t i = 0; i < data_.size(); ++i) data_[i] *= factor;
  }
  // The greatest size of a value, padding included; infinite if one is not a number.
  float greatest(const KernelTable& kernels) const {
    return kernels.particles.greatest(data_.data(), static_cast<std::ptrdiff_t>(data_.size()));
  }

 private:
  int rows_ = 0, stride_ = 0;
  std::size_t plane_ = 0;  // floats from one component to the next
  AlignedArray<float> data_;
};

// A component of a position as it is stored. Adding zero changes no other value, and makes +0 of -0: lanes
// beside a constraint have zero added to them or not, as wide as the kernels are.
inline float coordinate(double x) {
  return float(x) + 0.0f;
}

inline void zero(Row3 row, int lanes) {
  for (float* p : {row.x, row.y, row.z}) std::fill_n(p, lanes, 0.0f);
}

}  // namespace weft::physics
