// Ways to solve a scene (ways.h).
#include "tolerance/ways.h"

namespace weft::tolerance {

std::vector<Way> ways_of(const Scene& scene) {
  Solver asked = scene.solver;
  asked.sweep = Sweep::gauss_seidel;
  asked.tethers = false;
  asked.order = asked.iterations = 1;
  std::vector<Way> all;
  const auto add = [&](const char* name, Method method, Sweep sweep, int order, double work) {
    Solver s = asked;
    s.method = method;
    s.sweep = sweep;
    s.order = order;
    all.push_back({name, s, method != Method::compliant || order == 2 ? 2 : 1, work});
  };
  // Damping along the springs is known to one method only.
  if (scene.solver.method == Method::spring_friction) {
    add("spring_friction", Method::spring_friction, Sweep::gauss_seidel, 1, 1.5);
    return all;
  }
  add("spring", Method::spring, Sweep::gauss_seidel, 1, 1);
  add("compliant, line", Method::compliant, Sweep::line, 1, 4);
  add("compliant, line, order 2", Method::compliant, Sweep::line, 2, 4.5);
  return all;
}

}  // namespace weft::tolerance
