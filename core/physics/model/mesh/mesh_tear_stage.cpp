#include "physics/model/mesh/mesh_tear_stage.h"

#include <bit>
#include <limits>

#include "physics/kernels/mesh.h"
#include "physics/kernels/tear.h"

namespace weft::physics {
namespace {

class MeshTearStage final : public RowStage, private TornParts {
 public:
  MeshTearStage(const ClothParts& parts, MeshTearing& tearing)
      : RowStage("tear", "edges beyond their tear strain end", tearing.reach(),
                 std::int64_t(tearing.parts().edges.ends.size()), "constraints"),
        parts_(parts),
        tearing_(tearing),
        place_(std::size_t(items)) {
    first_.push_back(0);
    for (int j = 0; j < parts.particles.rows; ++j) {
      add_batches(tearing.edges_of_row(j));
      first_.push_back(int(batches_.size()));
    }
    overlong_.resize(batches_.size());
    tearing.tell(*this);
  }

  void run(int j, const Substep&) override {
    const auto first = std::size_t(first_[std::size_t(j)]);
    const int count = first_[std::size_t(j) + 1] - int(first);
    std::uint16_t* const overlong = overlong_.data() + first;
    if (!parts_.kernels.mesh.tear_edges(
            {batches_.data() + first, count, parts_.particles.x.row(0), overlong}))
      return;
    const std::vector<int>& edges = tearing_.edges_of_row(j);
    for (int n = 0; n < count; ++n)
      for (unsigned over = overlong[n]; over != 0; over &= over - 1)
        tearing_.end(edges[std::size_t(kTearBatch * n + std::countr_zero(over))]);
  }
  std::size_t bytes() const override {
    return batches_.size() * sizeof(TearBatch) + place_.size() * sizeof(int);
  }

 private:
  void add_batches(const std::vector<int>& edges) {
    const MeshEdges& all = tearing_.parts().edges;
    for (std::size_t n = 0; n < edges.size(); ++n) {
      const auto e = std::size_t(edges[n]);
      const auto near = std::int32_t(parts_.particles.lane(all.ends[e][0]));
      // Places of no edge look at a vertex of the batch: those of other rows may be moving.
      if (n % kTearBatch == 0) {
        TearBatch& none = batches_.emplace_back();
        std::fill(std::begin(none.near), std::end(none.near), near);
        std::fill(std::begin(none.far), std::end(none.far), near);
        std::fill(std::begin(none.longest), std::end(none.longest),
                  std::numeric_limits<float>::infinity());
      }
      TearBatch& b = batches_.back();
      b.near[n % kTearBatch] = near;
      b.far[n % kTearBatch] = std::int32_t(parts_.particles.lane(all.ends[e][1]));
      place_[e] = int((batches_.size() - 1) * kTearBatch + n % kTearBatch);
      set_edge(edges[n], true);
    }
  }
  void set_edge(int edge, bool holds) override {
    const double longest =
        tearing_.parts().edges.rest[std::size_t(edge)] * (1 + parts_.cloth.tear_strain);
    const auto place = std::size_t(place_[std::size_t(edge)]);
    batches_[place / kTearBatch].longest[place % kTearBatch] =
        holds ? float(longest * longest) : std::numeric_limits<float>::infinity();
  }

  ClothParts parts_;
  MeshTearing& tearing_;
  std::vector<TearBatch> batches_;
  std::vector<int> first_;  // batch of each row, and how many there are
  std::vector<int> place_;  // of every edge in the batches
  std::vector<std::uint16_t> overlong_;
};

}  // namespace

std::unique_ptr<RowStage> make_mesh_tear(const ClothParts& parts, MeshTearing& tearing) {
  return std::make_unique<MeshTearStage>(parts, tearing);
}

}  // namespace weft::physics
