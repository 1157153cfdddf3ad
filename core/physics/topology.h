// What holds together of a cloth that can tear: which constraints and triangles are left.
//
// A constraint dies past its tear strain, where a cutter passes, or where a caller cuts. With the
// constraints along a line die the longer ones that span it, and with an edge the triangles at it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "physics/family.h"

namespace weft::physics {

class Topology {
 public:
  // Gives every family of a whole cloth its links.
  Topology(int columns, int rows, int stride, std::vector<Family>& families);

  // Notes that constraints of row j died. Rows may be worked on side by side.
  void died(int j, int count) { died_[static_cast<std::size_t>(j)] += count; }
  // Ends constraint a of row j of a family, if it is alive.
  void end(const Family& family, int j, int a) {
    std::int32_t& lane = family.links->row(j)[a];
    if (lane != 0) died(j, 1);
    lane = 0;
  }
  // Follows what died since the last call: spanning constraints, triangles. Returns whether any
  // did.
  bool update();

  std::int64_t torn() const { return torn_; }         // constraints that are gone
  std::uint64_t version() const { return version_; }  // rises when triangles change
  // Triangles that are left, corners as j*stride + i; empty while the cloth is whole.
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  std::size_t bytes() const;

 private:
  const Family* family_at(int di, int dj) const;
  bool alive(int di, int dj, int i, int j) const;
  void end_spanning();
  void rebuild_triangles();

  int columns_, rows_, stride_;
  std::vector<Family>& families_;
  std::vector<std::unique_ptr<Links>> links_;
  std::vector<std::int64_t> died_;  // per row, ever
  std::int64_t torn_ = 0;
  std::uint64_t version_ = 0;
  std::vector<std::uint8_t> squares_;  // which triangles of every square are left, bits 1 and 2
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace weft::physics
