// Air on the triangles of a mesh, by the law of grids (wind_stage.h).
#include <algorithm>
#include <iterator>

#include "physics/kernels/mesh.h"
#include "physics/model/mesh/batches.h"
#include "physics/model/mesh/triangle_stage.h"
#include "physics/model/wind_stage.h"

namespace weft::physics {
namespace {

class MeshWindStage final : public WindStage, private TornParts {
 public:
  MeshWindStage(const ClothParts& parts, const MeshOrder& order,
                const std::vector<RestTriangle>& triangles, std::uint64_t seed,
                MeshTearing* tearing)
      : WindStage(parts, seed, std::int64_t(triangles.size())),
        parts_(parts),
        order_(order),
        triangles_(triangles),
        tearing_(tearing) {
    Batches all = batches_of(order, triangles, 3);
    for (const std::vector<int>& chosen : all.elements) batches_.push_back(batch_of(chosen));
    first_ = all.first;
    if (!tearing) return;
    batch_.resize(triangles.size());
    for (std::size_t b = 0; b < all.elements.size(); ++b)
      for (const int t : all.elements[b]) batch_[std::size_t(t)] = int(b);
    elements_ = std::move(all.elements);
    tearing->tell(*this);
  }

  std::size_t bytes() const override {
    return WindStage::bytes() + batches_.size() * sizeof(MeshAirBatch) +
           2 * batch_.size() * sizeof(int);
  }

 private:
  MeshAirBatch batch_of(const std::vector<int>& chosen) const {
    MeshAirBatch b{};
    for (const int t : chosen) {
      if (tearing_ && tearing_->gone(std::size_t(t))) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const int corner = triangles_[std::size_t(t)].corner[k];
        const int j = order_.rows[std::size_t(corner)], i = order_.lanes[std::size_t(corner)];
        b.corner[k][b.count] = j * parts_.particles.stride + i;
        b.sum[k][b.count] = j % 2 * parts_.particles.stride + i;
      }
      ++b.count;
    }
    // Places of no triangle look at one of the batch: the vertices of other rows may be moving.
    for (std::size_t k = 0; k < 3; ++k)
      std::fill(b.corner[k] + b.count, std::end(b.corner[k]), b.corner[k][0]);
    return b;
  }
  void set_triangle(int triangle) override {
    const auto b = std::size_t(batch_[std::size_t(triangle)]);
    batches_[b] = batch_of(elements_[b]);
  }
  void blow(int j, const Substep& s) override {
    MeshWind r{};
    set_air(r, s);
    r.batches = batches_.data() + first_[std::size_t(j)];
    r.count = first_[std::size_t(j) + 1] - first_[std::size_t(j)];
    r.x = parts_.particles.x.row(0);
    r.v = parts_.particles.v.row(0);
    r.sums = sums(0, s);
    parts_.kernels.mesh.mesh_wind(r);
  }

  ClothParts parts_;
  const MeshOrder& order_;
  const std::vector<RestTriangle>& triangles_;
  MeshTearing* const tearing_;  // null: it cannot
  std::vector<MeshAirBatch> batches_;
  std::vector<int> first_;  // batch of each row
  // Where it can tear: the triangles of each batch, and the batch of each triangle.
  std::vector<std::vector<int>> elements_;
  std::vector<int> batch_;
};

}  // namespace

std::unique_ptr<RowStage> make_mesh_wind(const ClothParts& parts, const MeshOrder& order,
                                         const std::vector<RestTriangle>& triangles,
                                         std::uint64_t seed, MeshTearing* tearing) {
  if (!blows(parts.scene.wind)) return nullptr;
  return std::make_unique<MeshWindStage>(parts, order, triangles, seed, tearing);
}

}  // namespace weft::physics
