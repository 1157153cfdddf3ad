// Triangles, edges and their strain, by the numbers of particles over all cloths.
#pragma once

#include <cstdint>
#include <vector>

#include "weft/simulation.h"

namespace weft::python {

std::int64_t particle_total(const Scene& scene);

// Three corners a triangle.
std::vector<std::uint32_t> triangles_of(const Simulation& simulation);

// Two ends a structural constraint: of each cloth those along u, row after row, then those along v.
std::vector<std::uint32_t> edges_of(const Scene& scene);

// Length / rest length - 1 of each of these; NaN where it is torn.
std::vector<double> strain_of(const Simulation& simulation);

}  // namespace weft::python
