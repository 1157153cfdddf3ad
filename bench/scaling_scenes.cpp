// The scenes that show how a frame is shared out (scaling_scenes.h).
#include "scaling_scenes.h"

#include <stdexcept>

#include "../tests/made_up_mesh.h"
#include "contact_scenes.h"
#include "weft/mesh.h"
#include "weft/read_scene.h"

namespace bench {
namespace {

using weft::Method;
using weft::Scene;
using weft::Sweep;

Scene shipped(const std::string& name) {
  weft::SceneFile file = weft::read_scene(name);
  if (!file.faults.empty()) throw std::runtime_error(name + ": " + file.faults[0].what);
  return std::move(file.scene);
}

Scene with_points(Scene scene, int n) {
  weft::Cloth& c = scene.cloths[0];
  c.grid.nx = c.grid.ny = n;
  for (weft::Pin& p : c.pins)
    if (p.i > 0) p.i = n - 1;
  return scene;
}

Scene projected(int n, Sweep sweep, int substeps) {
  Scene scene = with_points(shipped("swing"), n);
  scene.solver.method = Method::compliant;
  scene.solver.sweep = sweep;
  scene.time.substeps = substeps;
  return scene;
}

Scene membrane(int n, double frame) {
  Scene scene = with_points(shipped("swing"), n);
  weft::Cloth& c = scene.cloths[0];
  c.stiffness = weft::Cloth().stiffness;
  c.lumping = weft::Cloth().lumping;
  c.membrane = {3000, 2000, 200, 80, 0};
  scene.time.frame = frame;
  return scene;
}

// Some 1e5 vertices, held by a side.
Scene mesh(Method method, Sweep sweep, int points, int substeps) {
  Scene scene;
  scene.time = {1.0 / 60, substeps, 1};
  scene.solver.method = method;
  scene.solver.sweep = sweep;
  weft::Cloth& cloth = scene.cloths.emplace_back();
  cloth.mesh.shape = weft::made_up({.nx = points, .ny = points, .shift = 0.3});
  // Soft enough for forces in these substeps, so that work is all that counts; sweeps hold what is stiff.
  const double dt = scene.time.frame / substeps;
  cloth.stiffness.structural =
      method == Method::spring ? 0.02 * cloth.density / (double(points) * points) / (dt * dt) : 1e4;
  for (int n = 0; n < points; ++n) cloth.pins.push_back({n, 0, {}});
  return scene;
}

void add_sheets(std::vector<ScalingScene>& all, int n) {
  const std::string size = " N=" + std::to_string(n);
  const bool asked = n == 316;
  const auto add = [&](const std::string& name, const std::string& about, Scene scene, double at_16,
                       double at_2, std::vector<MeasuredElsewhere> elsewhere) {
    if (!asked) at_16 = at_2 = 0, elsewhere.clear();
    all.push_back({name + size, about, std::move(scene), 2, at_16, at_2, std::move(elsewhere)});
  };
  Scene springs = with_points(shipped("swing"), n);
  add("springs", "swing, automatic substeps", springs, 12, 1.95,
      {{2, 150 / 85.0}, {4, 150 / 46.0}, {8, 150 / 31.0}, {16, 6.5}});
  add("membrane", "swing as a membrane, automatic substeps", membrane(n, 1.0 / 60), 12, 0, {});
  add("gauss_seidel", "swing, compliant, 32 substeps", projected(n, Sweep::gauss_seidel, 32), 10,
      1.95, {{2, 19.3 / 13.7}, {4, 19.3 / 7.2}, {8, 19.3 / 5.8}, {16, 4.2}});
  add("lines", "inextensible: lines and tethers, 14 substeps",
      with_points(shipped("inextensible"), n), 8, 1.8,
      {{2, 20.6 / 13.8}, {4, 20.6 / 11.2}, {8, 20.6 / 9.1}, {16, 2.3}});
}

}  // namespace

std::vector<ScalingScene> scaling_scenes(bool quick) {
  std::vector<ScalingScene> all;
  if (quick) {
    add_sheets(all, 100);
    all.push_back({"fold50", "self-collision of surfaces", shipped("fold50"), 20, 0, 0, {}});
    return all;
  }
  add_sheets(all, 316);
  all.push_back({"springs N=1000",
                 "huge, automatic substeps",
                 shipped("huge"),
                 1,
                 14,
                 0,
                 {{2, 344 / 203.0}, {4, 344 / 104.0}, {8, 344 / 55.0}, {16, 8.3}}});
  all.push_back({"membrane N=1000",
                 "swing as a membrane, frames of 2 ms, automatic substeps",
                 membrane(1000, 2e-3),
                 1,
                 14,
                 0,
                 {}});
  all.push_back({"mesh, springs",
                 "1e5 vertices, 40 substeps",
                 mesh(Method::spring, Sweep::gauss_seidel, 316, 40),
                 2,
                 8,
                 0,
                 {}});
  all.push_back({"mesh, colours",
                 "1e5 vertices, compliant, 16 substeps",
                 mesh(Method::compliant, Sweep::gauss_seidel, 316, 16),
                 2,
                 8,
                 0,
                 {}});
  all.push_back({"mesh, strands",
                 "1e5 vertices, compliant, 16 substeps",
                 mesh(Method::compliant, Sweep::line, 316, 16),
                 2,
                 8,
                 0,
                 {}});
  all.push_back({"fold316",
                 "self-collision",
                 shipped("fold316"),
                 30,
                 8,
                 0,
                 {{2, 314 / 235.0}, {4, 314 / 183.0}, {8, 314 / 139.0}, {16, 2.2}}});
  all.push_back({"ppf_drape",
                 "five sheets on a ball, self-collision of surfaces",
                 contact_scene("ppf_drape", 0),
                 40,
                 8,
                 0,
                 {}});
  all.push_back(
      {"shirt", "a walking mannequin, self-collision of surfaces", shipped("shirt"), 20, 0, 0, {}});
  return all;
}

}  // namespace bench
