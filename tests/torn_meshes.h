// Meshes that tear, by every way that they are moved.
#pragma once

#include <algorithm>
#include <functional>
#include <set>

#include "contact_scenes.h"
#include "mesh_scenes.h"
#include "physics/model/tearing.h"
#include "weft/vec3.h"

namespace weft {

// Every way that a mesh is moved.
struct Way {
  const char* name;
  std::function<void(Scene&)> set;
};
inline std::vector<Way> ways() {
  std::vector<Way> all;
  for (const Material& m : kMaterials) all.push_back({m.name, m.set});
  const auto compliant = [](Scene& s) { s.solver.method = Method::compliant; };
  all.push_back({"compliant", compliant});
  all.push_back({"compliant that bends", [=](Scene& s) {
                   compliant(s);
                   s.solver.iterations = 2;
                   s.cloths[0].bending = 1e-4;
                 }});
  all.push_back({"line", [=](Scene& s) {
                   compliant(s);
                   s.solver.sweep = Sweep::line;
                   s.cloths[0].bending = 1e-4;
                 }});
  all.push_back({"second order", [=](Scene& s) {
                   compliant(s);
                   s.solver.order = 2;
                 }});
  all.push_back({"compliant membrane", [=](Scene& s) {
                   compliant(s);
                   s.solver.iterations = 2;
                   s.cloths[0].membrane = {
                       .warp = 400, .weft = 300, .coupling = 30, .shear = 60, .damping = 0};
                   s.cloths[0].bending = 1e-4;
                 }});
  return all;
}

// A strip along x, 3 m long, whose ends are drawn apart.
inline Scene tug(const Way& way, double strain) {
  Scene scene = scene_of(made_up({.nx = 31, .ny = 9, .width = 3, .shift = 0.2}));
  way.set(scene);
  scene.gravity = {};
  scene.cloths[0].tear_strain = strain;
  return scene;
}
inline void draw_apart(Simulation& run, const TriangleMesh& mesh, double speed) {
  std::vector<Vec3> v;
  for (const Vec3& p : mesh.vertices) v.push_back({speed * (p[0] - 1.5), 0, 0});
  run.set_state(run.positions(), flat(v));
}

// Pieces that edges which hold make, as a number for each vertex.
inline std::vector<int> pieces_of(const TriangleMesh& mesh, const Snapshot& now) {
  const std::set<physics::Joined> torn(now.cloths[0].torn.begin(), now.cloths[0].torn.end());
  std::vector<int> piece(mesh.vertices.size());
  for (std::size_t n = 0; n < piece.size(); ++n) piece[n] = int(n);
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
        int &p = piece[std::size_t(a)], &q = piece[std::size_t(b)];
        if (torn.contains({a, b}) || p == q) continue;
        p = q = std::min(p, q);
        changed = true;
      }
  }
  return piece;
}

}  // namespace weft
