// The triangles of a mesh against a collider.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "physics/contact/collider_triangles.h"

namespace weft::physics {
namespace {

// Of a mesh: each belongs to the first row that it reaches. This stage moves nothing. It finds which triangles touch as
// they lie now, so that its rows have no order; those are lifted by the stage that follows.
class MeshTriangles final : public ColliderTriangles {
 public:
  MeshTriangles(const ClothParts& parts, const Collider& collider, const StartInside& start,
                const SpeculativeCulling& particles)
      : ColliderTriangles(parts, collider, start, particles,
                          std::int64_t(parts.model.surface().all().size())),
        parts_(parts),
        rows_(std::size_t(parts.particles.rows)),
        moved_(rows_.size() * std::size_t(parts.particles.stride), -1) {
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
      t.first = std::size_t(first - t.j.begin());
      rows_[std::size_t(*first)].triangles.push_back(t);
    }
  }

  std::size_t bytes() const override {
    return ColliderTriangles::bytes() + std::size_t(items) * sizeof(Placed) +
           moved_.size() * sizeof(double);
  }

  bool rows_apart() const override { return true; }

  // Lifts those of row j that touched, and those of which a corner has been moved since.
  void lift_row(int j, const Substep& s) {
    Row& row = rows_[std::size_t(j)];
    if (row.looked != s.time) return;
    const ColliderRow r = collider().row(parts_, j, s);
    for (int pass = 0; pass < row.passes; ++pass)
      for (const Placed& t : row.triangles) {
        if (gone(t) || !(t.touched || moved(t, s))) continue;
        if (!lift(r, t.j, t.i, t.first)) continue;
        for (std::size_t k = 0; k < 3; ++k) moved_[lane(t, k)] = s.time;
      }
  }
  void restart() override {
    ColliderTriangles::restart();
    std::fill(moved_.begin(), moved_.end(), -1);
    for (Row& row : rows_) row.looked = -1;
  }

 private:
  struct Placed {
    std::size_t number;
    std::array<int, 3> j, i;  // row and lane of the corners
    std::size_t first;        // a corner in the row that it belongs to
    bool touched = false;     // when its row was looked at last
  };
  struct Row {
    std::vector<Placed> triangles;
    double looked = -1;  // s, the end of the substep in which something was found
    int passes = 0;
  };
  std::size_t lane(const Placed& t, std::size_t k) const {
    return std::size_t(t.j[k]) * std::size_t(parts_.particles.stride) + std::size_t(t.i[k]);
  }
  bool moved(const Placed& t, const Substep& s) const {
    return moved_[lane(t, 0)] == s.time || moved_[lane(t, 1)] == s.time ||
           moved_[lane(t, 2)] == s.time;
  }
  bool gone(const Placed& t) const {
    const std::vector<std::uint8_t>& all = parts_.model.surface().gone;
    return !all.empty() && all[t.number];
  }

  int last_row() const override { return parts_.particles.rows; }
  double greatest(const Rows& values, int j) const override {
    double square = 0;
    for (const Placed& t : rows_[std::size_t(j)].triangles)
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
    const ColliderRow r = collider().row(parts_, j, s);
    Row& row = rows_[std::size_t(j)];
    row.looked = s.time;
    row.passes = passes(longest);
    for (Placed& t : row.triangles) t.touched = !gone(t) && touches(r, t.j, t.i, t.first);
    return near;
  }

  ClothParts parts_;
  std::vector<Row> rows_;
  std::vector<double>
      moved_;  // of every lane: s, the end of the substep in which it was lifted last
};

// Rows share corners: one after the other.
class LiftTriangles final : public RowStage {
 public:
  explicit LiftTriangles(MeshTriangles& found)
      : RowStage("lifted_faces", "those that touch, and what moves with them", 1, found.items,
                 found.item),
        found_(found) {}
  using RowStage::run;
  void run(int j, const Substep& s) override { found_.lift_row(j, s); }
  double idle() const override { return found_.idle(); }

 private:
  MeshTriangles& found_;
};

}  // namespace

Stages make_collider_triangles(const ClothParts& parts, const Collider& collider,
                               const StartInside& start, const SpeculativeCulling& particles) {
  Stages stages;
  if (!caught_by_triangles(collider) || parts.model.surface().all().empty()) return stages;
  auto found = std::make_unique<MeshTriangles>(parts, collider, start, particles);
  auto lift = std::make_unique<LiftTriangles>(*found);
  stages.push_back(std::move(found));
  stages.push_back(std::move(lift));
  return stages;
}

}  // namespace weft::physics
