// What a simulation shows to the outside: read-only windows onto its own arrays, valid until the
// next call that changes the simulation. Copy what must last longer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace weft {

// One cloth as rows of particles: component arrays of `rows * stride` floats, particle (i,j) at
// j*stride + i with 0 <= i < columns. Lanes between columns and stride are padding.
struct ClothView {
  int columns = 0;                      // nx; of a mesh, whose rows differ, see lanes
  int rows = 0;                         // ny
  int stride = 0;                       // floats from one row to the next, a multiple of 16
  std::span<const float> x, y, z;       // position from the view's origin [m]
  std::span<const float> vx, vy, vz;    // velocity [m/s]; half a substep behind but for order 2
  std::span<const float> inverse_mass;  // 1/kg; 0 = pinned
  // Of a mesh, whose rows are of different lengths: where each particle is in the component arrays. Of a
  // grid: none.
  std::span<const std::uint32_t> lanes;
  std::uint64_t topology_version = 0;  // rises when triangles change (tearing)
  bool torn = false;                   // whether any constraint is gone
  // With topology_version > 0: the triangles that are left, corners as j*stride + i. Else all, two of
  // every square: (i,j) (i+1,j) (i,j+1) and (i+1,j) (i+1,j+1) (i,j+1).
  std::span<const std::array<std::uint32_t, 3>> triangles;
  // Of a mesh with texture coordinates, those of the triangles' corners. Of a grid's particles they are
  // (i/(nx-1), j/(ny-1)).
  std::span<const std::array<std::array<double, 2>, 3>> uv;
  // What each side of a tear keeps of the triangles that the tear passes through, so that no hole is
  // seen: triangles of points of their own, corners as numbers of points. Each point goes with a
  // particle (j*stride + i), whose colour and force are its own. They change with topology_version;
  // none with the scene's tears "holes".
  std::span<const std::array<std::uint32_t, 3>> tear_triangles;
  std::span<const std::array<float, 3>> tear_points;  // from the view's origin [m]
  std::span<const std::uint32_t> tear_particles;
  // Red, green and blue of its front, 0 … 1 in proportion to light, where the scene gives a colour.
  std::optional<std::array<double, 3>> color;
};

struct View {
  std::vector<ClothView> cloths;
  // m: what positions are counted from, in whole meters. Zero, unless the cloths start far from there:
  // single precision is coarse far from zero.
  std::array<double, 3> origin{};
  std::uint64_t version = 0;  // rises with every frame
  double time = 0;            // s since the start
};

}  // namespace weft
