// Ways to solve a scene that converge to its motion, or to that without its damping.
#pragma once

#include <string>
#include <vector>

#include "weft/scene.h"

namespace weft::tolerance {

struct Way {
  std::string name;
  Solver solver;
  int order;    // in the substep
  double work;  // of a particle and substep, of that of springs
  bool
      damps;  // as the scene asks; else it is a way only where it can be measured against one that does
  bool is_explicit() const { return solver.method != Method::compliant; }
};

std::vector<Way> ways_of(const Scene& scene);

}  // namespace weft::tolerance
