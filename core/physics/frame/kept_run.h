// What a snapshot holds besides what it tells: all that the next frame depends on (Simulation::State::keep).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "weft/simulation.h"

namespace weft {

struct Snapshot::Run {
  // Of what it is a run: only there does it go on.
  std::shared_ptr<const Scene> scene;
  std::uint64_t seed = 0;
  Method begun_method{}, method{};
  Solver begun_solver, solver;
  std::uint64_t told = 0;           // hash of what the snapshot tells: the rest belongs to that
  std::vector<std::uint8_t> tears;  // of every cloth, whether it can
  std::vector<std::byte> kept;
};

}  // namespace weft
