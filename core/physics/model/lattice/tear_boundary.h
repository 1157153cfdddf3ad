// The seams of a torn cloth: what each side keeps of the triangles that a tear passes through.
//
// A tear crosses the edges whose constraints are gone in their middles, a cut of the scene where its
// line does. Each particle draws its own share of such a triangle, up to where that point of the edge
// would lie if the sheet on its side went on as it is, so that a tear shows as a line that opens, not
// as a row of missing triangles:
//
// Of a triangle a, b, c without edge ab each of a and b has a half, up to c; without ab and ca the
// share of a is cut off from what b and c keep; without any edge each corner has its third.
//
// Points are x_p + Σ weight (x_to - x_from), the steps taken along constraints that are alive.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "physics/model/lattice/tearing.h"
#include "physics/model/torn_triangle.h"

namespace weft::physics {

class TearBoundary {
 public:
  explicit TearBoundary(const Cloth& cloth);
  // Follows the tearing, if its version has changed, and puts all points where they are now.
  void update(const LatticeTearing& tearing, const Lattice& lattice);

  const std::vector<std::array<float, 3>>& points() const { return places_; }  // m
  const std::vector<std::uint32_t>& particles() const {
    return owners_;
  }  // of points, j*stride + i
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  std::size_t bytes() const;

 private:
  struct Site {
    int i, j;
  };
  struct Step {
    std::uint32_t from = 0, to = 0;
    float weight = 0;
  };
  struct Point {
    std::uint32_t particle;
    Step steps[2];  // along the row, along the column
  };

  void rebuild(const LatticeTearing& tearing);
  float share(Site from, Site to) const;  // of the way to a neighbour, at which the tear crosses
  void add_triangle(const LatticeTearing& tearing, const std::array<Site, 3>& corner,
                    unsigned gone);
  // A point `along` and `down` steps from a particle, as the sheet lies on its side; none where it has
  // no constraint to tell.
  TornPoint point(const LatticeTearing& tearing, Site p, float along, float down);
  void add(const std::array<TornPoint, 3>& corners);

  // Of edges that cuts cross, from [column, row] to [column, row].
  std::map<std::array<int, 4>, float> shares_;
  std::uint64_t version_ = 0;
  std::vector<Point> points_;
  std::vector<std::uint32_t> owners_;
  std::vector<std::array<float, 3>> places_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace weft::physics
