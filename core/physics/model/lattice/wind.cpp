// Air on a grid: two triangles of every square, between its row and the next (wind_stage.h).
#include "physics/model/lattice/stages.h"
#include "physics/model/wind_stage.h"

namespace weft::physics {
namespace {

class SheetWind final : public WindStage {
 public:
  SheetWind(const LatticeParts& parts, std::uint64_t seed)
      : WindStage(parts, seed,
                  2 * std::int64_t(parts.lattice.columns - 1) * (parts.lattice.rows - 1)),
        parts_(parts) {}

 private:
  void blow(int j, const Substep& s) override {
    Lattice& l = parts_.lattice;
    if (j + 1 == l.rows) return;
    WindRow r{};
    set_air(r, s);
    r.columns = l.columns;
    r.x = l.x.row(j);
    r.x_next = l.x.row(j + 1);
    r.v = l.v.row(j);
    r.v_next = l.v.row(j + 1);
    r.air = sums(j, s);
    r.air_next = sums(j + 1, s);
    parts_.kernels.lattice.wind(r);
  }

  LatticeParts parts_;
};

}  // namespace

std::unique_ptr<RowStage> make_wind(const LatticeParts& parts, std::uint64_t seed) {
  if (!blows(parts.scene.wind)) return nullptr;
  return std::make_unique<SheetWind>(parts, seed);
}

}  // namespace weft::physics
