// Stage "gauss_seidel" of a membrane: one sweep over its cells (kernels/membrane_sweep.cpp), whose rows have two
// colours.
#include <cmath>
#include <memory>

#include "physics/kernels/membrane.h"
#include "physics/model/lattice/stages.h"
#include "physics/model/push.h"

namespace weft::physics {
namespace {

// One colour of rows, of damping or of strains.
class SweepCells final : public RowStage {
 public:
  SweepCells(const LatticeParts& parts, const SweepOptions& options, bool damps, int colour)
      : RowStage("gauss_seidel",
                 (damps ? "damping in " : "") +
                     std::string("cells of the membrane, rows of colour ") +
                     std::to_string(colour + 1),
                 1, std::int64_t(parts.lattice.columns - 1) * ((parts.lattice.rows - colour) / 2),
                 "cells"),
        parts_(parts),
        damps_(damps),
        scale_(std::size_t(parts.lattice.rows)) {
    Lattice& l = parts.lattice;
    MembraneSweep& s = sweep_;
    s.rows = l.rows;
    s.columns = l.columns;
    s.stride = l.stride;
    s.colour = colour;
    s.x = l.x.row(0);
    s.u = options.corrections->row(0);
    s.w = l.w(0);
    s.per_u = float(1 / spacing_u(parts.cloth.grid));
    s.per_v = float(1 / spacing_v(parts.cloth.grid));
    s.scale = scale_.data();
    set_stiffness(parts.cloth.membrane);
    if (options.multipliers) {
      const std::size_t first = damps ? kCellStresses : 0;
      s.stress = options.multipliers->row(first, 0);
      s.stress_plane = options.multipliers->row(first + 1, 0) - s.stress;
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
    if (damps_) sweep_.rate = float(parts_.cloth.membrane.damping / dt);
    sweep_.start = start_of(parts_, dt);
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
  void set_stiffness(const Membrane& m) {
    MembraneSweep& s = sweep_;
    const double coupling = std::abs(m.coupling), square = std::sqrt(m.warp / m.weft);
    const auto give = [](double stiffness) { return float(1 / stiffness); };
    s.give_edge[0] = give((m.warp - square * coupling) / 2);
    s.give_edge[1] = give((m.weft - coupling / square) / 2);
    s.give_torn[0] = give(m.warp / 2);
    s.give_torn[1] = give(m.weft / 2);
    s.give_shear = give(m.shear);
    if (coupling == 0) return;
    s.sum[0] = float(std::sqrt(square) / 2);
    s.sum[1] = float((m.coupling < 0 ? -0.5 : 0.5) / std::sqrt(square));
    s.give_sum = give(coupling);
    s.give_difference[0] = give(coupling * square);
    s.give_difference[1] = give(coupling / square);
  }

  LatticeParts parts_;
  bool damps_;
  std::vector<float> scale_;
  MembraneSweep sweep_{};
};

void append(const LatticeParts& parts, const SweepOptions& options, bool damps, Stages& stages) {
  for (int colour = 0; colour < 2; ++colour)
    if (parts.lattice.columns > 1 && parts.lattice.rows > colour + 1)
      stages.push_back(std::make_unique<SweepCells>(parts, options, damps, colour));
}

}  // namespace

void append_membrane_sweep(const LatticeParts& parts, const SweepOptions& options, Stages& stages) {
  append(parts, options, false, stages);
}

void append_membrane_damping(const LatticeParts& parts, Rows& corrections, Multipliers* multipliers,
                             Stages& stages) {
  SweepOptions options;
  options.corrections = &corrections;
  options.multipliers = multipliers;
  append(parts, options, true, stages);
}

}  // namespace weft::physics
