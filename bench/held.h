// Pins that move by keys, for references and other solvers: where each holds its particle.
#pragma once

#include <cstddef>
#include <vector>

#include "weft/scene.h"

namespace bench {

struct Held {
  std::size_t particle = 0;  // number, row after row
  weft::Vec3 start{};        // m, where the grid has it
  weft::Pin pin;
};

// The pins of a grid that move; each holds one particle and follows no body.
std::vector<Held> moving_pins(const weft::Cloth& cloth);

// Where it is at `time` [s]: by its keys, else where it starts, turned by its rotation.
weft::Vec3 place_of(const Held& held, double time);

}  // namespace bench
