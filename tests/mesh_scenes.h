// Scenes of one made-up mesh, and what its cloth is made of.
#pragma once

#include "made_up_mesh.h"
#include "physics/model/mesh/rest_triangles.h"
#include "weft/simulation.h"

namespace weft {

inline Scene scene_of(std::shared_ptr<const TriangleMesh> mesh) {
  Scene scene;
  scene.time.frame = 1.0 / 60;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.mesh.shape = std::move(mesh);
  cloth.density = 0.3;
  return scene;
}

inline const Membrane kCanvas{3000, 2000, 200, 80, 0};

struct Material {
  const char* name;
  void (*set)(Scene&);
};
inline const Material kMaterials[] = {
    {"springs", [](Scene&) {}},
    {"damped springs",
     [](Scene& s) {
       s.solver.method = Method::spring_friction;
       s.cloths[0].spring_damping.structural = 0.05;
     }},
    {"membrane", [](Scene& s) { s.cloths[0].membrane = kCanvas; }},
    {"damped membrane that bends",
     [](Scene& s) {
       s.cloths[0].membrane = kCanvas;
       s.cloths[0].membrane.damping = 2e-4;
       s.cloths[0].bending.warp = 2e-4, s.cloths[0].bending.weft = 1e-4;
       s.cloths[0].bending.twist = 3e-5, s.cloths[0].bending.damping = 1e-3;
     }},
    {"springs that bend", [](Scene& s) { s.cloths[0].bending = 1e-4; }},
};

// The force on one coordinate of a vertex as the slope of the energy, by differences.
inline double energy_slope(const std::vector<physics::RestTriangle>& triangles,
                           const physics::MeshMaterial& material, std::vector<Vec3>& x,
                           std::size_t vertex, std::size_t k) {
  const double h = 1e-6, at = x[vertex][k];
  x[vertex][k] = at + h;
  const double more = physics::mesh_energy(triangles, material, x);
  x[vertex][k] = at - h;
  const double less = physics::mesh_energy(triangles, material, x);
  x[vertex][k] = at;
  return (less - more) / (2 * h);
}

inline std::vector<Vec3> positions_of(const Simulation& run) {
  const std::vector<double> all = run.positions();
  std::vector<Vec3> x(all.size() / 3);
  for (std::size_t n = 0; n < all.size(); ++n) x[n / 3][n % 3] = all[n];
  return x;
}

}  // namespace weft
