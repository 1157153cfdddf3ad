// What is written down of a cloth in a frame (frame_record.h).
#include "physics/frame_record.h"

#include <algorithm>

#include "physics/energy.h"

namespace weft::physics {
namespace {

void copy(ConstRow3 from, Row3 to, int lanes) {
  std::copy_n(from.x, lanes, to.x);
  std::copy_n(from.y, lanes, to.y);
  std::copy_n(from.z, lanes, to.z);
}

}  // namespace

FrameRecord::FrameRecord(Lattice& lattice, const Vec3& gravity, const KernelTable& kernels)
    : lattice_(lattice),
      gravity_(gravity),
      kernels_(kernels),
      x_(lattice.rows, lattice.stride),
      v_(lattice.rows, lattice.stride),
      seen_(std::size_t(lattice.rows)) {}

void FrameRecord::keep(RowSpan rows) {
  const int lanes = (rows.end - rows.begin) * lattice_.stride;
  copy(lattice_.x.row(rows.begin), x_.row(rows.begin), lanes);
  copy(lattice_.v.row(rows.begin), v_.row(rows.begin), lanes);
}

void FrameRecord::look(RowSpan rows) {
  for (int j = rows.begin; j < rows.end; ++j)
    seen_[std::size_t(j)] =
        kernels_.tally(tally_row(lattice_, lattice_.x.row(j), lattice_.v.row(j), j, gravity_));
}

void FrameRecord::restore() {
  lattice_.x.copy(x_);
  lattice_.v.copy(v_);
}

Tally FrameRecord::tally() const {
  Tally all;
  for (const Tally& row : seen_) all += row;
  return all;
}

}  // namespace weft::physics
