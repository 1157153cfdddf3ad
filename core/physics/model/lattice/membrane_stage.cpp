// Stage "membrane": the forces of the membrane and of bending, and the leapfrog step (kernels/membrane.cpp) in one pass over
// the rows. A row is moved in place as soon as the cells on both of its sides have pulled it.
#include "physics/model/lattice/bending.h"
#include "physics/model/lattice/membrane.h"
#include "physics/model/lattice/plain_rows.h"
#include "physics/model/lattice/tearing.h"

namespace weft::physics {
namespace {

class MembraneStage final : public PlainLeapfrogStage {
 public:
  explicit MembraneStage(const LatticeParts& parts)
      : PlainLeapfrogStage(
            "membrane",
            std::string(bends(parts) ? "stretch, shear and bending" : "stretch and shear") +
                " of the sheet" +
                (parts.cloth.membrane.damping > 0 || parts.cloth.bending.damping > 0
                     ? " with damping"
                     : "") +
                ", leapfrog step",
            parts, std::make_shared<Remainders>(), bends(parts) ? 2 : 1),
        share_(std::size_t(parts.lattice.stride)) {
    const MembraneCells cells(parts.cloth, parts.stencils, spring_repeats(parts.scene.solver));
    for (int j = 0; j < parts.lattice.rows; ++j) constants_.push_back(cells.constants(j));
    if (bends(parts)) set_bending();
    std::fill_n(share_.data(), parts.lattice.columns, 1.0f);
    share_[0] = share_[std::size_t(parts.lattice.columns) - 1] = 0.5f;
  }
  std::size_t bytes() const override {
    return PlainLeapfrogStage::bytes() + constants_.size() * sizeof(MembraneConstants) +
           bend_.size() * sizeof(BendStiffness) + share_.size() * sizeof(float);
  }
  void run(int begin, int end, const Substep& s) override {
    const Grid& grid = parts_.cloth.grid;
    const double hu = spacing_u(grid), hv = spacing_v(grid);
    MembraneRows r{};
    r.constants = constants_.data();
    r.share = share_.data();
    r.half_u = float(1 / (2 * hu * hu));
    r.half_v = float(1 / (2 * hv * hv));
    r.damping = float(parts_.cloth.membrane.damping);
    if (!bend_.empty()) {
      r.bend = bend_.data();
      r.bend_damping = float(parts_.cloth.bending.damping);
      if (const BendLinks* links = parts_.tearing ? parts_.tearing->bend_links() : nullptr) {
        r.along = links->along.data();
        r.across = links->across.data();
        r.twist = links->twist.data();
      }
    }
    for_alike(r, begin, end, s, parts_.kernels.lattice.membrane_rows);
  }

 private:
  static bool bends(const LatticeParts& parts) { return parts.cloth.bending.given(); }
  void set_bending() {
    const BendingStiffness k = bending_stiffness(parts_.cloth);
    const int rows = parts_.lattice.rows;
    for (int j = 0; j < rows; ++j)
      bend_.push_back({float(k.along * width_share(parts_.cloth, 0, j, 1, 0)),
                       j + 2 < rows ? float(k.across) : 0, j + 1 < rows ? float(k.twist) : 0});
  }

  std::vector<MembraneConstants> constants_;  // of each row
  std::vector<BendStiffness> bend_;           // of each row; none: the sheet does not bend
  AlignedArray<float> share_;
};

}  // namespace

std::unique_ptr<RowStage> make_membrane(const LatticeParts& parts) {
  return std::make_unique<MembraneStage>(parts);
}

}  // namespace weft::physics
