// The triangles of a grid against a collider: two of every square, what a tear has ended left out.
#include <algorithm>
#include <cmath>

#include "physics/contact/collider_triangles.h"

namespace weft::physics {
namespace {

constexpr double kReached =
    2;  // edges up to so many times the flat ones lie within the kernel's reach

// The links of a triangle's edges, which end where a tear goes through.
class Edges {
 public:
  explicit Edges(const LatticeParts& parts) : parts_(parts) {
    for (const Stencil& f : parts.stencils)
      for (std::size_t n = 0; n < kOffsets.size(); ++n)
        if (f.di == kOffsets[n][0] && f.dj == kOffsets[n][1]) links_[n] = f.links;
  }
  // The greatest difference of positions or velocities between two ends, of the triangles between rows j and
  // j+1 [m, m/s].
  double greatest(const Rows& values, int j) const {
    const Lattice& l = parts_.lattice;
    float square = 0;
    const auto look = [&](std::size_t edge, int row) {
      Stencil f;
      f.di = kOffsets[edge][0];
      f.dj = kOffsets[edge][1];
      f.links = links_[edge];
      square = std::max(
          square, parts_.kernels.lattice.greatest_square(far_rows(f, values, l.columns, row)));
    };
    look(kAlong, j);
    look(kAlong, j + 1);
    look(kAcross, j);
    look(kDiagonal, j);
    return std::sqrt(double(square));
  }
  // Whether the first or second triangle of square (i, j) is whole.
  bool whole(int i, int j, int triangle) const {
    const auto alive = [&](std::size_t edge, int row, int lane) {
      return !links_[edge] || links_[edge]->alive(row, lane);
    };
    return alive(kDiagonal, j, i) &&
           (triangle == 0 ? alive(kAlong, j, i) && alive(kAcross, j, i)
                          : alive(kAcross, j, i + 1) && alive(kAlong, j + 1, i));
  }

 private:
  static constexpr std::size_t kAlong = 0, kAcross = 1, kDiagonal = 2;
  static constexpr std::array<std::array<int, 2>, 3> kOffsets{{{1, 0}, {0, 1}, {-1, 1}}};
  const LatticeParts& parts_;
  std::array<Links*, 3> links_{};  // null: cannot tear
};

// Of a grid: two of every square, between its row and the next, found by a kernel.
class SquareTriangles final : public ColliderTriangles {
 public:
  SquareTriangles(const LatticeParts& parts, const Collider& collider, const StartInside& start,
                  const SpeculativeCulling& particles)
      : ColliderTriangles(parts, collider, start, particles,
                          2 * std::int64_t(parts.lattice.columns - 1) * (parts.lattice.rows - 1)),
        parts_(parts),
        edges_(parts_) {}

  void reserve_slots(int slots) override {
    bound_ = Rows(slots, parts_.lattice.stride);
    room_ = AlignedArray<std::int32_t>(room() * std::size_t(slots));
  }
  std::size_t bytes() const override {
    return ColliderTriangles::bytes() + bound_.bytes() + room_.size() * sizeof(std::int32_t);
  }

 private:
  int last_row() const override { return parts_.lattice.rows - 1; }
  double greatest(const Rows& values, int j) const override { return edges_.greatest(values, j); }

  RowReach look(int j, const Substep& s, double longest) override {
    if (!parts_.kernels.colliders[collider().shape()]->below_faces)
      return look_at_all(j, s, longest);
    Lattice& l = parts_.lattice;
    FacesRow f;
    const ColliderRow row = collider().row(parts_, j, s);
    f.row = row;
    f.x_next = l.x.row(j + 1);
    f.v_next = l.v.row(j + 1);
    f.edge = float(std::max(edge(), longest / kReached));
    f.slack = float(allowed().at(longest));
    const Row3 bound = bound_.row(s.slot);
    f.bound[0] = bound.x;
    f.bound[1] = bound.y;
    f.room = room_.data() + room() * std::size_t(s.slot);
    const RowReach reach = parts_.kernels.colliders[collider().shape()]->below_faces(f);
    // The way of a substep matters only where it is long against the collider.
    const float way = reach.speed * f.row.dt;
    const float near = way > 0.5f * f.row.shape.thin ? way : -f.slack;
    for (int pass = 0; pass < passes(longest); ++pass)
      for (int i = 0; i + 1 < l.columns; ++i) {
        if (f.bound[0][i] < near && edges_.whole(i, j, 0)) lift(row, {j, j, j + 1}, {i, i + 1, i});
        if (f.bound[1][i] < near && edges_.whole(i, j, 1))
          lift(row, {j, j + 1, j + 1}, {i + 1, i + 1, i});
      }
    return reach;
  }

  // Where no kernel tells which are near.
  RowReach look_at_all(int j, const Substep& s, double longest) {
    const RowReach near = reach_of_particles(j, s);
    if (out_of_reach(near, s, longest)) return near;
    const ColliderRow row = collider().row(parts_, j, s);
    for (int pass = 0; pass < passes(longest); ++pass)
      for (int i = 0; i + 1 < parts_.lattice.columns; ++i) {
        if (edges_.whole(i, j, 0)) lift(row, {j, j, j + 1}, {i, i + 1, i});
        if (edges_.whole(i, j, 1)) lift(row, {j, j + 1, j + 1}, {i + 1, i + 1, i});
      }
    return near;
  }

  std::size_t room() const { return 2 * std::size_t(parts_.lattice.stride) + 16; }

  LatticeParts parts_;
  Edges edges_;
  Rows bound_;
  AlignedArray<std::int32_t> room_;
};

}  // namespace

Stages make_collider_triangles(const LatticeParts& parts, const Collider& collider,
                               const StartInside& start, const SpeculativeCulling& particles) {
  Stages stages;
  if (!caught_by_triangles(collider)) return stages;
  if (resolves(parts.cloth, collider) && parts.stencils.empty()) return stages;
  stages.push_back(std::make_unique<SquareTriangles>(parts, collider, start, particles));
  return stages;
}

}  // namespace weft::physics
