// Air on the triangles of a mesh, by the law of grids (wind_stage.h).
#include "physics/kernels/mesh.h"
#include "physics/model/mesh/batches.h"
#include "physics/model/mesh/triangle_stage.h"
#include "physics/model/wind_stage.h"

namespace weft::physics {
namespace {

class MeshWindStage final : public WindStage {
 public:
  MeshWindStage(const ClothParts& parts, const MeshOrder& order,
                const std::vector<RestTriangle>& triangles, std::uint64_t seed)
      : WindStage(parts, seed, std::int64_t(triangles.size())), parts_(parts) {
    const Batches all = batches_of(order, triangles, 3);
    for (const std::vector<int>& chosen : all.elements) {
      MeshAirBatch b{};
      b.count = int(chosen.size());
      for (std::size_t n = 0; n < chosen.size(); ++n)
        for (std::size_t k = 0; k < 3; ++k) {
          const int corner = triangles[std::size_t(chosen[n])].corner[k];
          const int j = order.rows[std::size_t(corner)], i = order.lanes[std::size_t(corner)];
          b.corner[k][n] = j * parts.particles.stride + i;
          b.sum[k][n] = j % 2 * parts.particles.stride + i;
        }
      batches_.push_back(b);
    }
    first_ = all.first;
  }

  std::size_t bytes() const override {
    return WindStage::bytes() + batches_.size() * sizeof(MeshAirBatch);
  }

 private:
  void blow(int j, const Substep& s) override {
    MeshWind r{};
    set_air(r, s);
    r.batches = batches_.data() + first_[std::size_t(j)];
    r.count = first_[std::size_t(j) + 1] - first_[std::size_t(j)];
    r.x = parts_.particles.x.row(0);
    r.v = parts_.particles.v.row(0);
    r.sums = sums(0, s);
    parts_.kernels.mesh_wind(r);
  }

  ClothParts parts_;
  std::vector<MeshAirBatch> batches_;
  std::vector<int> first_;  // batch of each row
};

}  // namespace

std::unique_ptr<RowStage> make_mesh_wind(const ClothParts& parts, const MeshOrder& order,
                                         const std::vector<RestTriangle>& triangles,
                                         std::uint64_t seed) {
  if (!blows(parts.scene.wind)) return nullptr;
  return std::make_unique<MeshWindStage>(parts, order, triangles, seed);
}

}  // namespace weft::physics
