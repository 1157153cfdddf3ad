// A mesh as contact between sheets looks at it: its vertices in patches of neighbours, each a row of
// particles, so that a patch is to a mesh what a block is to a grid (blocks.h). The rows are copies, taken
// when contact looks; what it changes goes to the cloth's own.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "physics/kernels/contact.h"
#include "physics/model/cloth_model.h"
#include "physics/step/threads.h"

namespace weft::physics {

class MeshPatches {
 public:
  // `rest`: where every vertex is at rest [m].
  MeshPatches(const ClothModel& model, std::vector<Vec3> rest);

  Particles& points() { return *points_; }
  const Particles& points() const { return *points_; }
  // Takes over positions, velocities and inverse masses as they are now.
  void copy(Threads& threads);
  // Where a point is in the cloth's own rows.
  Particles::Place place(int row, int column) const {
    return places_[std::size_t(points_->first[std::size_t(row)] + column)];
  }
  // Of every vertex, where it is at rest [m]; the mesh's triangles.
  const std::vector<Vec3>& rest() const { return rest_; }
  const std::vector<std::array<int, 3>>& triangles() const { return surface_.all(); }
  // The points once more, as records: positions and velocities, row after row; a vertex's number among them.
  const std::vector<Place>& x() const { return x_; }
  const std::vector<Place>& v() const { return v_; }
  std::int32_t record(int vertex) const {
    const auto [row, column] = points_->place(vertex);
    return points_->first[std::size_t(row)] + column;
  }

  // Of every patch, the points of others that its vertices have triangles with, row after row.
  std::vector<std::vector<Particles::Place>> borders() const;

  // Vertices that are less than `range` apart at rest, straight, and by the mesh's edges no more than twice
  // that: neighbours on the surface, by their numbers. Two layers that lie on each other at rest are none. Seams
  // are edges of no length, and what is nearer by them than straight is neighbours.
  std::vector<std::vector<int>> neighbours(double range) const;
  // Those that are no more than `range` apart by edges and seams, and nearer so than straight; ascending.
  std::vector<std::vector<int>> sewn_neighbours(double range) const;
  bool sewn() const { return !surface_.sewn.empty(); }
  std::size_t bytes() const;

 private:
  // visit(vertex, other, m between them by edges and seams) for all that are no more than `most` apart so.
  template <class Visit>
  void for_each_way(double most, const Visit& visit) const;

  const Particles& particles_;
  const SurfaceMesh& surface_;
  const std::vector<Vec3> rest_;
  std::unique_ptr<Particles> points_;
  std::vector<Particles::Place> places_;  // of the points, row after row
  std::vector<Place> x_, v_;
};

}  // namespace weft::physics
