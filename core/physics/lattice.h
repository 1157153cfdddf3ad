// Storage of one cloth: a lattice of particles as rows in separate component arrays
// (structure of arrays), each 64-byte aligned, each row padded by at least 16 lanes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "physics/aligned_array.h"
#include "physics/kernels/kernels.h"
#include "weft/scene.h"

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
    float* base = data_.data() + static_cast<std::size_t>(j) * stride_;
    return {base, base + plane_, base + 2 * plane_};
  }
  ConstRow3 row(int j) const {
    const float* base = data_.data() + static_cast<std::size_t>(j) * stride_;
    return {base, base + plane_, base + 2 * plane_};
  }
  std::span<const float> component(int axis) const {
    return {data_.data() + axis * plane_, static_cast<std::size_t>(rows_) * stride_};
  }
  float& at(int axis, int j, int i) {
    return data_[axis * plane_ + static_cast<std::size_t>(j) * stride_ + i];
  }
  float at(int axis, int j, int i) const {
    return data_[axis * plane_ + static_cast<std::size_t>(j) * stride_ + i];
  }
  std::size_t bytes() const { return data_.size() * sizeof(float); }
  void clear() { std::fill_n(data_.data(), data_.size(), 0.0f); }
  // Takes over the values of rows of the same shape.
  void copy(const Rows& from) { std::copy_n(from.data_.data(), data_.size(), data_.data()); }
  void scale(float factor) {
    for (std::size_t i = 0; i < data_.size(); ++i) data_[i] *= factor;
  }
  // The greatest size of a value, padding included; infinite if one is not a number.
  float greatest(const KernelTable& kernels) const {
    return kernels.greatest(data_.data(), static_cast<std::ptrdiff_t>(data_.size()));
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

struct Lattice {
  int columns = 0, rows = 0, stride = 0;
  Rows x;  // position [m]
  Rows v;  // velocity [m/s]
  // Earlier positions, where a stage asks for them: as predicted, or, for the second order, before the
  // substep.
  Rows previous;
  AlignedArray<float> inverse_mass;  // 1/kg, 0 = pinned or padding
  // 1/kg, of every particle of row j, or 0 where they differ: kernels for a plain row are faster.
  AlignedArray<float> row_inverse_mass;

  // Changes the inverse mass of one particle.
  void set_inverse_mass(int j, int i, float value);
  // To be called after the inverse masses of row j were changed through w().
  void weigh_row(int j);
  float* w(int j) { return inverse_mass.data() + static_cast<std::size_t>(j) * stride; }
  const float* w(int j) const { return inverse_mass.data() + static_cast<std::size_t>(j) * stride; }
  float w(int j, int i) const { return inverse_mass[static_cast<std::size_t>(j) * stride + i]; }
  std::size_t bytes() const {
    return x.bytes() + v.bytes() + previous.bytes() + inverse_mass.size() * sizeof(float);
  }
};

// The particles of a cloth at rest at the start, jittered along the sheet's normal by `seed`.
Lattice make_lattice(const Cloth& cloth, int cloth_index, std::uint64_t seed, bool keep_previous);

}  // namespace weft::physics
