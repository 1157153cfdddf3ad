#include "physics/model/mesh/mesh_tear_stage.h"

#include <bit>
#include <limits>

#include "physics/kernels/mesh.h"
#include "physics/kernels/tear.h"

namespace weft::physics {
namespace {

class MeshTearStage final : public RowStage, private TornParts {
 public:
  MeshTearStage(const ClothParts& parts, MeshTearing& tearing, const MidstLengths& midst)
      : RowStage("tear", "edges beyond their tear strain end", tearing.reach(),
                 std::int64_t(tearing.parts().edges.ends.size()), "constraints"),
        parts_(parts),
        tearing_(tearing),
        midst_(midst),
        place_(std::size_t(items)) {
    first_.push_back(0);
    for (int j = 0; j < parts.particles.rows; ++j) {
      add_batches(tearing.edges_of_row(j));
      first_.push_back(int(batches_.size()));
    }
    overlong_.resize(batches_.size());
    if (!midst.edges.empty() || !midst.triangles.empty()) {
      asked_.resize(batches_.size() * kTearBatch);
      for (std::size_t e = 0; e < place_.size(); ++e) ask(int(e));
    }
    tearing.tell(*this);
  }

  void run(int j, const Substep&) override { asked_.empty() ? ask_places(j) : ask_sweeps(j); }
  std::size_t bytes() const override {
    return batches_.size() * sizeof(TearBatch) + place_.size() * sizeof(int) +
           (midst_.edges.size() + midst_.triangles.size()) * sizeof(const float*) +
           asked_.size() * sizeof(Asked);
  }

 private:
  void ask_places(int j) {
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
  void ask_sweeps(int j) {
    const std::vector<int>& edges = tearing_.edges_of_row(j);
    const Asked* const asked = asked_.data() + std::ptrdiff_t(kTearBatch) * first_[std::size_t(j)];
    for (std::size_t n = 0; n < edges.size(); ++n)
      if (*asked[n].one + *asked[n].other > asked[n].longest) tearing_.end(edges[n]);
  }

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
    if (asked_.empty()) return;
    ask(edge);
    if (midst_.edges.empty())
      tearing_.for_each_side(edge, [&](const MeshTearing::Side& side) {
        for (std::size_t k = 0; k < 3; ++k) ask(tearing_.edge_of(side.triangle, k));
      });
  }
  // Of a membrane, an edge is as long as in the mean of its triangles that have one.
  void ask(int edge) {
    static constexpr float kNothing = 0;
    const auto place = std::size_t(place_[std::size_t(edge)]);
    Asked& a = asked_[place];
    a = {&kNothing, &kNothing, 2 * batches_[place / kTearBatch].longest[place % kTearBatch]};
    if (!midst_.edges.empty()) a.one = a.other = midst_.edges[std::size_t(edge)];
    if (!midst_.edges.empty()) return;
    bool first = true;
    tearing_.for_each_side(edge, [&](const MeshTearing::Side& side) {
      if (tearing_.parts().triangles[std::size_t(side.triangle)].area == 0) return;
      a.other = midst_.triangles[std::size_t(side.triangle)] + kBatch * side.k;
      if (first) a.one = a.other;
      first = false;
    });
  }

  // Where two squared lengths are told of an edge, and what their sum is at most [m²].
  struct Asked {
    const float *one = nullptr, *other = nullptr;
    float longest = 0;
  };

  ClothParts parts_;
  MeshTearing& tearing_;
  const MidstLengths midst_;
  std::vector<TearBatch> batches_;
  std::vector<int> first_;  // batch of each row, and how many there are
  std::vector<int> place_;  // of every edge in the batches
  std::vector<std::uint16_t> overlong_;
  std::vector<Asked> asked_;  // of every edge in the batches; none: no sweep tells
};

}  // namespace

std::unique_ptr<RowStage> make_mesh_tear(const ClothParts& parts, MeshTearing& tearing,
                                         const MidstLengths& midst) {
  return std::make_unique<MeshTearStage>(parts, tearing, midst);
}

}  // namespace weft::physics
