// Ways to solve a scene (ways.h).
#include "tolerance/ways.h"

#include <algorithm>

namespace weft::tolerance {

std::vector<Way> ways_of(const Scene& scene) {
  Solver asked = scene.solver;
  asked.sweep = Sweep::gauss_seidel;
  asked.tethers = false;
  asked.order = 1;
  if (!asked.iterate_springs) asked.iterations = 1;  // else they are a part of the material
  // Which sweeps over meshes leave out.
  const bool damped = std::ranges::any_of(scene.cloths, [](const Cloth& cloth) {
    return cloth.mesh.given() && cloth.bending.damping > 0;
  });
  std::vector<Way> all;
  const auto add = [&](const char* name, Method method, Sweep sweep, int order, double work) {
    Solver s = asked;
    s.method = method;
    s.sweep = sweep;
    s.order = order;
    const bool forces = method != Method::compliant;
    all.push_back({name, s, forces || order == 2 ? 2 : 1, work, forces || !damped});
  };
  // Damping along the springs is known to one method only.
  if (scene.solver.method == Method::spring_friction) {
    add("spring_friction", Method::spring_friction, Sweep::gauss_seidel, 1, 1.5);
    return all;
  }
  add("spring", Method::spring, Sweep::gauss_seidel, 1, 1);
  if (asked.iterate_springs && asked.iterations > 1) return all;
  add("compliant, line", Method::compliant, Sweep::line, 1, 4);
  add("compliant, line, order 2", Method::compliant, Sweep::line, 2, 4.5);
  return all;
}

}  // namespace weft::tolerance
