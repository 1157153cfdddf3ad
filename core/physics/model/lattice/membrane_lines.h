// What line sweeps know of a membrane: how stiff its lines are, and the squared lengths that these are to have
// (kernels/membrane_squares.cpp, membrane_line.cpp).
#pragma once

#include "physics/model/lattice/line_batches.h"
#include "physics/model/lattice/membrane.h"
#include "physics/model/lattice/stages.h"

namespace weft::physics {

class MembraneLines {
 public:
  explicit MembraneLines(const LatticeParts& parts);

  // Before substeps of this length [s].
  void prepare(double dt);
  // Of a stencil's constraints in row j, whose columns stand for `share` of an inner one's width: 1/(K h²) [m²/kg]
  // where the energy is ½ K ((e·e - s)/2)² and h the time that forces have.
  double compliance(const Stencil& stencil, int j, double share) const;

  // Newton steps of a line. Of the diagonals, which come first and are softer, what one step leaves is little.
  static int steps(const Stencil& stencil) { return stencil.kind == Kind::shear ? 1 : 2; }

  // Before every sweep: what its lines are to have, by where the particles lie, with corrections if there are some.
  void look(LineBatches& batches, const Rows* corrections);
  // Of a stencil between rows, laid out as the lattice, constraint 0 of a row in lane 0; null: its rest length.
  const float* squares(const Stencil& stencil, int row) const;
  // Of edges along rows, as lanes of a group; null: their rest length.
  const float* turned(int group, LineBatches& batches);
  // Where a cell has both of its diagonals, which hold together; null: everywhere.
  const std::int32_t* sheared(int row) const;
  std::size_t bytes() const;

 private:
  // Lanes that kernels read before the first row and after the last.
  static constexpr std::size_t kGuard = 32;
  template <class T>
  AlignedArray<T> guarded() const;
  template <class T>
  const T* row_of(const AlignedArray<T>& lanes, int row) const {
    return lanes.data() + kGuard + std::size_t(row) * std::size_t(parts_.lattice.stride);
  }
  double gradient(int j) const;
  bool damped() const { return parts_.cloth.membrane.damping > 0; }
  // Whether edges are to have other squares than those of their rest lengths.
  bool looks_at_edges() const { return parts_.cloth.membrane.coupling != 0 || damped(); }
  MembraneSquares rows(int begin, int end, const Rows* corrections);

  LatticeParts parts_;
  double hu_, hv_;
  double dt_ = 0, rate_ = 0;  // s; damping over dt
  AlignedArray<float> diagonals_, antidiagonals_, along_, across_, share_, turned_;
  AlignedArray<std::int32_t> sheared_;
  std::vector<MembraneSquares::Coupling> coupling_;
};

}  // namespace weft::physics
