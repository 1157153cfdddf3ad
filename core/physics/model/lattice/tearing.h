// What holds together of a cloth that can tear: which constraints, bending terms and triangles are
// left.
//
// A constraint dies past its tear strain, where a cutter passes, or where a caller cuts. With the
// constraints along a line die the longer ones that span it, with a structural one the bending over
// it, and with an edge the triangles at it, of which each side keeps its part (tear_boundary.h). Looked at
// again is only what lies about the rows where something died.
//
// With Tears::particles (seed 000) a constraint takes both its particles with it: these lose all their
// constraints, with the bending and the triangles there, and nothing else dies.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <memory>
#include <vector>

#include "physics/model/lattice/bending.h"
#include "physics/model/lattice/stencil.h"
#include "physics/model/tearing.h"

namespace weft::physics {

class TearBoundary;

class LatticeTearing final : public Tearing {
 public:
  // Gives every stencil of a whole cloth its links.
  LatticeTearing(const Lattice& lattice, std::vector<Stencil>& stencils, const Cloth& cloth);
  ~LatticeTearing() override;

  // Notes that constraints of row j died. Rows may be worked on side by side.
  void died(int j, int count) { died_[static_cast<std::size_t>(j)] += count; }
  // Ends constraint a of row j of a stencil, if it is alive.
  void end(const Stencil& stencil, int j, int a) {
    assert(j >= 0 && j + stencil.dj < rows_ && a >= 0 && a < stencil.per_row(columns_));
    std::int32_t& lane = stencil.links->row(j)[a];
    if (lane != 0) died(j, 1);
    lane = 0;
  }
  // Spanning constraints, bending, triangles.
  bool update() override;
  void remember() override;
  void go_back() override;
  std::int64_t torn() const override { return torn_; }
  std::uint64_t version() const override { return version_; }
  std::vector<Joined> torn_list() const override;
  void set_torn(const std::vector<Joined>& torn) override;
  std::int64_t end_all(const std::vector<Joined>& constraints) override;
  TornSurface surface() override;

  std::int64_t torn(int j) const { return died_[static_cast<std::size_t>(j)]; }  // of row j
  // The same, as far as bending has followed.
  std::int64_t followed(int j) const { return followed_[static_cast<std::size_t>(j)]; }
  // Triangles that are left whole, corners as j*stride + i; empty while the cloth is whole.
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  // Null without bending.
  const BendLinks* bend_links() const { return bend_links_.get(); }
  std::size_t bytes() const;

  // Edges of the first and the second triangle of square (i, j) that are gone: bits 0 to 2 and 3 to
  // 5, edge n from corner n to the next. Corners: (i,j) (i+1,j) (i,j+1) and (i+1,j) (i+1,j+1) (i,j+1).
  std::uint8_t gone(int i, int j) const {
    return squares_[static_cast<std::size_t>(j) * (columns_ - 1) + i];
  }
  // Whether the constraint (di, dj) from particle (i, j) is there; true when the cloth has none such.
  bool alive(int di, int dj, int i, int j) const;
  // The same, false when the cloth has none such.
  bool joined(int di, int dj, int i, int j) const;
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int stride() const { return stride_; }

 private:
  void make_whole();
  void end_joined(const Joined& constraint);
  const Stencil* stencil_at(int di, int dj) const;
  void end_spanning(int row);
  void end_particles();
  void list_rows();
  bool free(int i, int j) const;
  void end_bending(int row);
  bool look_at_squares(int row);
  void end_pinches(int j);
  void list_triangles();

  const Lattice& lattice_;
  int columns_, rows_, stride_;
  const Tears tears_;
  std::vector<Stencil>& stencils_;
  std::vector<std::unique_ptr<Links>> links_, remembered_;
  std::unique_ptr<BendLinks> bend_links_;
  std::vector<std::int64_t> died_, followed_;  // per row, ever
  std::vector<int> rows_about_;                // where something died
  std::int64_t torn_ = 0;
  std::uint64_t version_ = 0;
  std::vector<std::uint8_t> squares_;
  std::vector<std::uint8_t> removed_;  // of each particle, j*columns + i (Tears::particles)
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::unique_ptr<TearBoundary> boundary_;  // null: not shown
};

}  // namespace weft::physics
