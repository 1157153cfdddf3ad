// Where a mesh that is flat at rest lies nearly flat, so that its patches do not touch: as of the blocks of a
// grid (blocks.h), with the triangles' gradients for edges.
//
// With unit vectors e, f across each other on the flat mesh, a triangle takes a way a e + b f on it to a U + b V.
// Along the straight way between two vertices, over triangles with U within ε_u of one vector and V within ε_v of
// another, the equation in blocks.h holds. The way has to stay on the mesh: pairs of patches with an edge of the
// mesh between them are never known to be flat.
#pragma once

#include <utility>
#include <vector>

#include "physics/contact/self/mesh_patches.h"
#include "physics/kernels/contact.h"

namespace weft::physics {

class FlatPatches {
 public:
  // Pairs of patches that are less than `reach` apart at rest [m]; none where the mesh is not flat.
  FlatPatches(MeshPatches& patches, double reach);

  // How U and V spread over the triangles of a patch, and how fast they change (along, across).
  void measure(int patch, BlockBounds& bounds) const;

  // Patches near each other, a <= b, and all that the straight ways between their vertices cross.
  struct Pair {
    int a, b;
    std::vector<int> crossed;
  };
  // In order.
  const std::vector<Pair>& pairs() const { return pairs_; }
  // Of the pair a <= b, or -1.
  int pair(int a, int b) const;
  std::size_t bytes() const;

 private:
  struct Triangle {
    std::array<std::int32_t, 3> corner;  // records
    float u[2], v[2];                    // U and V by the sides from the first corner [1/m]
  };
  struct Box {
    double low[2], high[2];
  };
  using Flat = std::array<double, 2>;

  bool lay_flat(std::vector<Flat>& at) const;
  void add_triangles(const std::vector<Flat>& at);
  void add_pairs(const std::vector<Flat>& at, double reach);
  bool keeps_within(int a, int b, const Box& about, const std::vector<Flat>& at,
                    const std::vector<std::array<int, 2>>& border) const;

  const MeshPatches& patches_;
  std::vector<Triangle> triangles_;  // patch by patch
  std::vector<std::size_t> begin_;   // of every patch's
  std::vector<Pair> pairs_;
};

}  // namespace weft::physics
