// Stage "cut" of a mesh: edges that a cutting collider's surface reaches end.
#include <algorithm>
#include <cmath>

#include "physics/contact/collider_stage.h"
#include "physics/contact/cut_way.h"
#include "physics/model/mesh/mesh_tearing.h"

namespace weft::physics {
namespace {

class MeshCutStage final : public ColliderRowStage {
 public:
  MeshCutStage(const ClothParts& parts, MeshTearing& tearing, const Collider& collider,
               const StartInside& start)
      : ColliderRowStage(parts, collider, start, false, "cut", "edges in a cutter's way end",
                         tearing.reach(), std::int64_t(tearing.parts().edges.ends.size()),
                         "constraints"),
        parts_(parts),
        upright_(collider.shape),
        tearing_(tearing) {
    for (const Joined& ends : tearing.parts().edges.ends)
      ends_.push_back({parts.particles.place(ends[0]), parts.particles.place(ends[1])});
  }

  void run(int j, const Substep& s) override {
    if (far_.skip(j, s)) return;
    const ColliderRow row = collider_.row(parts_, j, s);
    RowReach reach{1e30f, 0};
    std::visit([&](const auto& shape) { cut_row(shape, row, j, reach); }, upright_.shape);
    reach.speed += row.rim;
    far_.found(j, s, reach);
  }
  std::size_t bytes() const override { return ends_.size() * sizeof(ends_[0]); }

 private:
  template <class Shape>
  void cut_row(const Shape& shape, const ColliderRow& row, int j, RowReach& reach) {
    const Particles& p = parts_.particles;
    const auto seen = [&](const Particles::Place& at) {
      return upright_.into(row.into(row.about_place(p.position(at.j, at.i))));
    };
    for (const int edge : tearing_.edges_of_row(j)) {
      if (!tearing_.holds(std::size_t(edge))) continue;
      const auto [near, far] = ends_[std::size_t(edge)];
      const Vec3 from = seen(near), e = minus(seen(far), from);
      const double clearance = nearest_of(shape, from).distance - row.offset - length(e);
      if (clearance <= 0 && comes_inside(shape, row.offset, from, e)) {
        tearing_.end(edge);
        continue;
      }
      reach.clearance = std::min(reach.clearance, float(std::max(0.0, clearance)));
      reach.speed = std::max({reach.speed, speed(near), speed(far)});
    }
  }
  float speed(const Particles::Place& at) const {
    double square = 0;
    for (int k = 0; k < 3; ++k) square += std::pow(double(parts_.particles.v.at(k, at.j, at.i)), 2);
    return float(std::sqrt(square));
  }

  ClothParts parts_;
  Upright upright_;
  MeshTearing& tearing_;
  std::vector<std::array<Particles::Place, 2>> ends_;  // of every edge
};

}  // namespace

std::unique_ptr<RowStage> make_cut(const ClothParts& parts, MeshTearing& tearing,
                                   const Collider& collider, const StartInside& start) {
  return std::make_unique<MeshCutStage>(parts, tearing, collider, start);
}

}  // namespace weft::physics
