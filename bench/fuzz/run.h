// One run of a scene: frames, with inputs in between, and a hash of everything after each.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "inputs.h"

namespace fuzz {

// What is run.
struct Case {
  std::uint64_t seed = 0;
  weft::Scene scene;
  Inputs inputs = Inputs::none;
  double speed = 0;   // m/s, of particles at the start, each another way
  double work = 2e5;  // of all frames, as work_of_substep() counts it
};

// Gives particles their velocities of the start.
void begin(const Case& c, weft::Simulation& simulation);

// What comes out. Equal for any threads and instruction set.
struct Trace {
  std::vector<std::uint64_t> hashes;  // before the first frame, and after each
  std::string status;
  friend bool operator==(const Trace&, const Trace&) = default;
};

// The place in a view's arrays of every particle of a cloth, by its number.
std::vector<std::size_t> lanes_of(const weft::ClothView& cloth);

// Hash of all that view() shows, of the substeps in use and of the status.
std::uint64_t hash_of(const weft::Simulation& simulation);

// Called after every frame; `touched` tells whether there was an input before it.
using Watch = std::function<void(const weft::Simulation&, bool touched)>;

// Runs until the work is done.
Trace run(const Case& c, weft::Simulation& simulation, weft::Recorder* recorder,
          const Watch& watch);

// Where two traces differ, "" where they are equal.
std::string difference(const Trace& a, const Trace& b);

}  // namespace fuzz
