// Scenes of one made-up mesh, and what its cloth is made of.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "made_up_mesh.h"
#include "physics/model/mesh/rest_triangles.h"
#include "weft/simulation.h"
#include "weft/vec3.h"

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

// Every vertex off its place by up to so much each way [m].
inline std::vector<Vec3> rumpled(const TriangleMesh& mesh, double by, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Vec3> x = mesh.vertices;
  for (Vec3& p : x)
    for (double& value : p) value += by * (double(random()) / 2147483648.0 - 1);
  return x;
}

inline std::vector<double> flat(const std::vector<Vec3>& x) {
  std::vector<double> all;
  for (const Vec3& p : x) all.insert(all.end(), p.begin(), p.end());
  return all;
}

// The greatest distance [m].
inline double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const Vec3 e = minus(a[n], b[n]);
    most = std::max(most, length(e));
  }
  return most;
}

// Puts a mesh where it is rumpled, at rest; returns where it is then, as rounded.
inline std::vector<Vec3> rumple(Simulation& run, const TriangleMesh& mesh, double by,
                                unsigned seed) {
  const std::vector<Vec3> start = rumpled(mesh, by, seed);
  run.set_state(flat(start), std::vector<double>(3 * start.size()));
  return positions_of(run);
}

// Of a strip of 1 m and 0.3 kg/m² that hangs by its end under 9.81 m/s², of a membrane whose stress is
// half_stiffness (s² - 1) along it [N/m]: ∫ s, with half_stiffness (s² - 1) s = weight below.
inline double hung_length(double half_stiffness) {
  double length = 0;
  for (int k = 0; k < 1000; ++k) {
    const double pull = 0.3 * 9.81 * (1 - (k + 0.5) / 1000);
    double s = 1;
    for (int i = 0; i < 50; ++i)
      s -= (half_stiffness * (s * s - 1) * s - pull) / (half_stiffness * (3 * s * s - 1));
    length += s / 1000;
  }
  return length;
}

}  // namespace weft
