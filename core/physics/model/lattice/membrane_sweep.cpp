// Stage "gauss_seidel" of a membrane: one sweep over its cells (kernels/membrane_sweep.cpp), whose rows have two
// colours.
#include <algorithm>
#include <memory>

#include "physics/kernels/membrane.h"
#include "physics/model/lattice/stages.h"
#include "physics/model/push.h"

namespace weft::physics {
namespace {

// One colour of rows.
class SweepCells final : public RowStage {
 public:
  SweepCells(const LatticeParts& parts, const SweepOptions& options, int colour)
      : RowStage("gauss_seidel",
                 "cells of the membrane, rows of colour " + std::to_string(colour + 1), 1,
                 std::int64_t(parts.lattice.columns - 1) * ((parts.lattice.rows - colour) / 2),
                 "cells"),
        parts_(parts),
        scale_(std::size_t(parts.lattice.rows)) {
    Lattice& l = parts.lattice;
    const Membrane& m = parts.cloth.membrane;
    MembraneSweep& s = sweep_;
    s.rows = l.rows;
    s.columns = l.columns;
    s.stride = l.stride;
    s.colour = colour;
    s.x = l.x.row(0);
    s.u = options.corrections->row(0);
    s.w = l.w(0);
    s.v = l.v.row(0);
    if (parts.scene.solver.order == 2) s.previous = l.previous.row(0);
    s.per_u = float(1 / spacing_u(parts.cloth.grid));
    s.per_v = float(1 / spacing_v(parts.cloth.grid));
    s.scale = scale_.data();
    const double determinant = m.warp * m.weft - m.coupling * m.coupling;
    s.give[0] = float(m.weft / determinant);
    s.give[1] = float(m.warp / determinant);
    s.give[2] = float(-m.coupling / determinant);
    s.give[3] = float(1 / m.shear);
    s.give_difference[0] = float(1 / m.warp);
    s.give_difference[1] = float(1 / m.weft);
    if (options.multipliers) {
      s.stress = options.multipliers->row(0, 0);
      s.stress_plane = options.multipliers->row(1, 0) - s.stress;
    }
    for (std::size_t f = 0; f < kCellStencils && parts.tearing; ++f) {
      const Stencil& stencil = parts.stencils[f];
      s.alive[f] = stencil.links->row(0);
      const float longest = tear_length(parts.cloth, stencil);
      if (options.tears) s.longest_square[f] = longest * longest;
    }
    s.ended = parts.ended;
  }

  std::size_t bytes() const override { return scale_.size() * sizeof(float); }
  void prepare(double dt) override {
    const Grid& grid = parts_.cloth.grid;
    const double h = dt * implicit_share(parts_.scene.solver);
    const double area = spacing_u(grid) * spacing_v(grid);
    const int cells = parts_.lattice.rows - 1;
    for (int j = 0; j < cells; ++j)
      scale_[std::size_t(j)] =
          float(area * (1 - parts_.cloth.stiffness_gradient * (j + 0.5) / cells) * h * h);
    sweep_.rate = float(parts_.cloth.membrane.damping / dt);
    sweep_.dt = float(dt);
  }
  // Damping reads them as they were predicted.
  Velocities velocities() const override { return Velocities::left_alone; }
  void run(int begin, int end, const Substep&) override {
    MembraneSweep s = sweep_;
    s.begin = begin;
    s.end = end;
    parts_.kernels.lattice.sweep_membrane(s);
  }

 private:
  LatticeParts parts_;
  std::vector<float> scale_;
  MembraneSweep sweep_{};
};

}  // namespace

void append_membrane_sweep(const LatticeParts& parts, const SweepOptions& options, Stages& stages) {
  for (int colour = 0; colour < 2; ++colour)
    if (parts.lattice.columns > 1 && parts.lattice.rows > colour + 1)
      stages.push_back(std::make_unique<SweepCells>(parts, options, colour));
}

}  // namespace weft::physics
