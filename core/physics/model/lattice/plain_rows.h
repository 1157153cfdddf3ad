// What the stages share that take the six stencils of a plain cloth in one pass over the rows
// (kernels/plain_rows.h): the rows and the sums carried from row to row.
#pragma once

#include "physics/model/lattice/stages.h"
#include "physics/model/remainders.h"

namespace weft::physics {

// stencils_of lists the six of a plain cloth in one order, which these stages take for granted.
inline bool is_plain(const LatticeParts& parts) {
  return parts.cloth.level == 0 && parts.stencils.size() == kPlainStencils;
}

class PlainRowsStage : public RowStage {
 public:
  PlainRowsStage(const std::string& stage_name, const std::string& stage_detail,
                 const LatticeParts& parts, int rows_reached = 2)
      : RowStage(stage_name, stage_detail, rows_reached, parts.constraints(), "constraints"),
        parts_(parts) {}

  void reserve_slots(int slots) override { carry_ = AlignedArray<float>(slots * carried()); }
  std::size_t bytes() const override { return carry_.size() * sizeof(float); }
  void start(const Substep& s) override { std::fill_n(carry(s), carried(), 0.0f); }

 protected:
  // Everything but the law's own. The first row of a substep finds nothing carried.
  void fill(PlainRows& r, int begin, int end, const Substep& s) {
    Lattice& l = parts_.lattice;
    r.begin = begin;
    r.end = end;
    r.rows = l.rows;
    r.columns = l.columns;
    r.stride = l.stride;
    r.x = l.x.row(0);
    r.v = l.v.row(0);
    r.w = l.w(0);
    r.sides = l.column_width[0] < 1;
    r.width = l.column_width.data();
    r.inverse_width = l.inverse_width.data();
    for (std::size_t f = 0; f < parts_.stencils.size(); ++f) {
      Links* const links = parts_.stencils[f].links;
      r.alive[f] = links ? links->row(0) : nullptr;
    }
    if (begin == 0) start(s);
    r.carry = carry(s);
  }

  LatticeParts parts_;

 private:
  std::size_t carried() const { return 7 * std::size_t(parts_.lattice.stride); }
  float* carry(const Substep& s) { return carry_.data() + s.slot * carried(); }

  AlignedArray<float> carry_;
};

// Those that move particles by forces.
class PlainLeapfrogStage : public Leapfrog<PlainRowsStage> {
 public:
  template <class... Arguments>
  PlainLeapfrogStage(const std::string& stage_name, const std::string& stage_detail,
                     const LatticeParts& parts, std::shared_ptr<Remainders> left,
                     Arguments... arguments)
      : Leapfrog(parts, std::move(left), stage_name, stage_detail, parts, arguments...) {}

 protected:
  // Calls run(rows) for every range of rows of one inverse mass.
  template <class Rows, class Run>
  void for_alike(Rows r, int begin, int end, const Substep& s, Run&& run_rows) {
    const auto& weights = parts_.lattice.row_inverse_mass;
    for (int first = begin; first < end;) {
      int last = first + 1;
      while (last < end && weights[last] == weights[first]) ++last;
      fill(r, first, last, s);
      r.alike = weights[first];
      r.advance = advance_of(parts_, s);
      r.left = left_->row(0);
      run_rows(r);
      first = last;
    }
  }
};

}  // namespace weft::physics
