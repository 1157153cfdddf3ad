// Stage "cut": constraints that a cutting collider's surface reaches end (seed 000, scene 3).
#include <cmath>

#include "physics/contact/collider_stage.h"
#include "physics/contact/cut_way.h"
#include "physics/model/lattice/tearing.h"

namespace weft::physics {
namespace {

// A constraint is cut where a point of it comes inside the offset surface.
class CutStage final : public ColliderRowStage {
 public:
  CutStage(const LatticeParts& parts, const Collider& collider, const StartInside& start)
      : ColliderRowStage(parts, collider, start, false, "cut", "constraints in a cutter's way end",
                         greatest_reach(parts), parts.constraints(), "constraints"),
        parts_(parts),
        upright_(collider.shape),
        tearing_(*parts.tearing) {
    for (const Stencil& f : parts.stencils) longest_ = std::max(longest_, f.rest);
  }
  void reserve_slots(int slots) override {
    distances_ = AlignedArray<float>(std::size_t(slots) * parts_.lattice.stride);
  }

  void run(int j, const Substep& s) override {
    if (far_.skip(j, s)) return;
    Lattice& l = parts_.lattice;
    const ColliderRow r = collider_.row(parts_, j, s);
    const auto at = [&](int row, int i) {
      return upright_.into(r.into(r.about_place(l.position(row, i))));
    };
    RowReach reach{1e30f, 0};
    float* const distance = distances_.data() + std::size_t(s.slot) * l.stride;
    std::visit(
        [&](const auto& shape) {
          for (int i = 0; i < l.columns; ++i) {
            distance[i] = float(nearest_of(shape, at(j, i)).distance - r.offset);
            reach.clearance = std::min(reach.clearance, distance[i]);
            double square = 0;
            for (int k = 0; k < 3; ++k) square += double(l.v.at(k, j, i)) * l.v.at(k, j, i);
            reach.speed = std::max(reach.speed, float(std::sqrt(square)));
          }
          if (reach.clearance < 2 * longest_)
            for (const Stencil& f : parts_.stencils)
              cut_stencil(shape, r.offset, f, j, at, distance);
        },
        upright_.shape);
    reach.clearance -= float(2 * longest_);
    reach.speed += r.rim;
    far_.found(j, s, reach);
  }

 private:
  template <class Shape, class At>
  void cut_stencil(const Shape& shape, double offset, const Stencil& f, int j, const At& at,
                   const float* distance) {
    if (j + f.dj >= parts_.lattice.rows) return;
    for (int a = 0; a < f.per_row(parts_.lattice.columns); ++a) {
      if (!f.alive(j, a) || distance[a + f.near()] > 2 * longest_) continue;
      const Vec3 from = at(j, a + f.near()), e = minus(at(j + f.dj, a + f.far()), from);
      if (comes_inside(shape, offset, from, e)) tearing_.end(f, j, a);
    }
  }

  LatticeParts parts_;
  Upright upright_;
  LatticeTearing& tearing_;
  double longest_ = 0;  // m, of a constraint at rest
  AlignedArray<float> distances_;
};

}  // namespace

std::unique_ptr<RowStage> make_cut(const LatticeParts& parts, const Collider& collider,
                                   const StartInside& start) {
  return std::make_unique<CutStage>(parts, collider, start);
}

}  // namespace weft::physics
