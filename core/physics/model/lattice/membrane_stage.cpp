// Stage "membrane": the membrane's forces and the leapfrog step (kernels/membrane.cpp) in one pass over
// the rows. A row is moved in place as soon as the cells on both of its sides have pulled it.
#include "physics/model/lattice/membrane.h"
#include "physics/model/lattice/plain_rows.h"

namespace weft::physics {
namespace {

class MembraneStage final : public PlainRowsStage {
 public:
  explicit MembraneStage(const LatticeParts& parts)
      : PlainRowsStage("membrane",
                       std::string("stretch and shear of the sheet") +
                           (parts.cloth.membrane.damping > 0 ? " with damping" : "") +
                           ", leapfrog step",
                       parts, 1),
        share_(std::size_t(parts.lattice.stride)) {
    const MembraneCells cells(parts.cloth, parts.stencils, spring_repeats(parts.scene.solver));
    for (int j = 0; j < parts.lattice.rows; ++j) constants_.push_back(cells.constants(j));
    std::fill_n(share_.data(), parts.lattice.columns, 1.0f);
    share_[0] = share_[std::size_t(parts.lattice.columns) - 1] = 0.5f;
  }
  std::size_t bytes() const override {
    return PlainRowsStage::bytes() + constants_.size() * sizeof(MembraneConstants) +
           share_.size() * sizeof(float);
  }
  bool moves_particles() const override { return true; }
  void run(int begin, int end, const Substep& s) override {
    const Grid& grid = parts_.cloth.grid;
    const double hu = spacing_u(grid), hv = spacing_v(grid);
    MembraneRows r{};
    r.constants = constants_.data();
    r.share = share_.data();
    r.half_u = float(1 / (2 * hu * hu));
    r.half_v = float(1 / (2 * hv * hv));
    r.damping = float(parts_.cloth.membrane.damping);
    for_alike(r, begin, end, s, parts_.kernels.lattice.membrane_rows);
  }

 private:
  std::vector<MembraneConstants> constants_;  // of each row
  AlignedArray<float> share_;
};

}  // namespace

std::unique_ptr<RowStage> make_membrane(const LatticeParts& parts) {
  return std::make_unique<MembraneStage>(parts);
}

}  // namespace weft::physics
