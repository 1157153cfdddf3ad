// A copy of what a simulation shows at one instant, made by the simulation's thread and drawn by
// the window's, so that neither waits for the other.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "picture/linear.h"
#include "weft/shape.h"
#include "weft/simulation.h"

namespace weft::viewer {

// One cloth: component arrays of rows * stride floats, as in weft/view.h. A mesh is one row, in the order of
// its numbers.
struct ClothCopy {
  int columns = 0, rows = 0, stride = 0;
  std::vector<float> x, y, z;
  std::vector<float> vx, vy, vz;
  std::vector<float> inverse_mass;
  std::uint64_t topology_version = 0;  // with the scene's serial: which triangles are left
  bool torn = false;                   // a mesh, too, shows its triangles alone
  bool mesh = false;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // corners as at(i, j); unless torn: empty
  // What is left beside the tears (weft/view.h): points, the particle of each, triangles of them.
  std::vector<std::array<float, 3>> tear_points;
  std::vector<std::uint32_t> tear_particles;
  std::vector<std::array<std::uint32_t, 3>> tear_triangles;

  std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(stride) +
           static_cast<std::size_t>(i);
  }
  // Of the particle with this number.
  std::size_t at(int particle) const { return at(particle % columns, particle / columns); }
  Vec3f position(int particle) const {
    const std::size_t p = at(particle);
    return {x[p], y[p], z[p]};
  }
};

// Everything is about the view's origin: the scene, the cloths and the bodies.
struct FrameData {
  Vec3 origin{};  // m, where that is
  std::shared_ptr<const Scene> scene;
  std::uint64_t scene_serial = 0;  // rises with every scene or parameter that was set
  std::uint64_t change = 0;        // rises when the state is set without a new frame
  std::vector<ClothCopy> cloths;
  std::vector<Collider> bodies;  // the colliders where they stand now, without keys
  std::int64_t frame = 0;
  double time = 0;  // s
};

// Copies the view and the colliders of the scene as simulated, where it stands; keeps the memory that
// `to` has.
void copy_view(const View& view, const Scene& scene, FrameData& to);

// The collider at `time` along its path, without keys.
Collider collider_at(const Collider& collider, double time);

// A shape with its place at zero, to single precision: the same all along a path.
Shape about_its_place(const Shape& shape);

// What of the colliders can be seen as a whole: all but planes.
Bounds collider_bounds(const std::vector<Collider>& bodies);
// Of all particles; of a torn cloth, those that still hold a triangle.
Bounds cloth_bounds(const FrameData& frame_data);

}  // namespace weft::viewer
