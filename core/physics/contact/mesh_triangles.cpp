// The triangles of a mesh against a collider.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "physics/contact/collider_triangles.h"

namespace weft::physics {
namespace {

// Of a mesh: each belongs to the first row that it reaches.
class MeshTriangles final : public ColliderTriangles {
 public:
  MeshTriangles(const ClothParts& parts, const Collider& collider, const StartInside& start,
                const SpeculativeCulling& particles)
      : ColliderTriangles(parts, collider, start, particles,
                          std::int64_t(parts.model.surface().all().size())),
        parts_(parts),
        rows_(std::size_t(parts.particles.rows)) {
    const auto& all = parts.model.surface().all();
    for (std::size_t n = 0; n < all.size(); ++n) {
      const auto& corners = all[n];
      Placed t;
      t.number = n;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [j, i] = parts.particles.place(corners[k]);
        t.j[k] = j, t.i[k] = i;
      }
      const auto [first, last] = std::minmax_element(t.j.begin(), t.j.end());
      assert(*last - *first <= reach);
      rows_[std::size_t(*first)].push_back(t);
    }
  }

  std::size_t bytes() const override {
    return ColliderTriangles::bytes() + std::size_t(items) * sizeof(Placed);
  }

 private:
  struct Placed {
    std::size_t number;
    std::array<int, 3> j, i;  // row and lane of the corners
  };
  bool gone(const Placed& t) const {
    const std::vector<std::uint8_t>& all = parts_.model.surface().gone;
    return !all.empty() && all[t.number];
  }

  int last_row() const override { return parts_.particles.rows; }
  double greatest(const Rows& values, int j) const override {
    double square = 0;
    for (const Placed& t : rows_[std::size_t(j)])
      for (std::size_t k = 0; k < 3 && !gone(t); ++k) {
        const std::size_t next = (k + 1) % 3;
        Vec3 e{};
        for (int m = 0; m < 3; ++m)
          e[std::size_t(m)] =
              double(values.at(m, t.j[next], t.i[next])) - values.at(m, t.j[k], t.i[k]);
        square = std::max(square, dot(e, e));
      }
    return std::sqrt(square);
  }

  RowReach look(int j, const Substep& s, double longest) override {
    const RowReach near = reach_of_particles(j, s);
    if (out_of_reach(near, s, longest)) return near;
    const ColliderRow row = collider().row(parts_, j, s);
    for (int pass = 0; pass < passes(longest); ++pass)
      for (const Placed& t : rows_[std::size_t(j)])
        if (!gone(t)) lift(row, t.j, t.i);
    return near;
  }

  ClothParts parts_;
  std::vector<std::vector<Placed>> rows_;
};

}  // namespace

std::unique_ptr<RowStage> make_collider_triangles(const ClothParts& parts, const Collider& collider,
                                                  const StartInside& start,
                                                  const SpeculativeCulling& particles) {
  if (!caught_by_triangles(collider) || parts.model.surface().all().empty()) return nullptr;
  return std::make_unique<MeshTriangles>(parts, collider, start, particles);
}

}  // namespace weft::physics
