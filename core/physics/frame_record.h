// What is written down of a cloth in a frame: its rows as they lie at the start, to go back to, and
// how large positions are and what the motion holds at the end. The wavefront does both where the rows
// are in the cache anyway: as it first comes to them, and as it leaves them.
#pragma once

#include <cstddef>
#include <vector>

#include "physics/lattice.h"
#include "physics/stage.h"

namespace weft::physics {

class FrameRecord {
 public:
  // Lattice and kernels outlive the record. `gravity` [m/s²].
  FrameRecord(Lattice& lattice, const Vec3& gravity, const KernelTable& kernels);

  // Keeps rows as they are at the frame's start; looks at them at its end.
  void keep(RowSpan rows);
  void look(RowSpan rows);
  void keep() { keep({0, lattice_.rows}); }
  void look() { look({0, lattice_.rows}); }
  // Puts all rows back to how they were kept.
  void restore();

  // At the frame's start.
  const Rows& x() const { return x_; }
  const Rows& v() const { return v_; }
  // At its end, summed in the order of the rows.
  Tally tally() const;
  std::size_t bytes() const { return x_.bytes() + v_.bytes() + seen_.size() * sizeof(Tally); }

 private:
  Lattice& lattice_;
  const Vec3 gravity_;
  const KernelTable& kernels_;
  Rows x_, v_;
  std::vector<Tally> seen_;  // of every row
};

}  // namespace weft::physics
