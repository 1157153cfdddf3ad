// Storage of one cloth: a lattice of particles as rows in separate component arrays
// (structure of arrays), each 64-byte aligned, each row padded by at least 16 lanes.
#pragma once

#include "physics/step/rows.h"
#include "weft/scene.h"

namespace weft::physics {

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
