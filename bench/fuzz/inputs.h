// Random inputs between frames. What is done depends on the seed, the number of the frame and the
// simulation's state alone, so that runs that are equal so far get the same.
#pragma once

#include <optional>

#include "draw.h"
#include "weft/recording.h"

namespace fuzz {

// Whether a scene gets inputs, and which.
enum class Inputs {
  none,
  recorded,  // those that recordings hold
  all,       // and set_state(), snapshot(), restore()
};
Inputs inputs_of(std::uint64_t seed);

// Particles get random velocities up to `speed` [m/s] in each direction, and places up to `off` [m]
// from where they are.
void throw_cloth(weft::Simulation& simulation, double speed, double off, Draw draw);

class Hand {
 public:
  Hand(std::uint64_t seed, Inputs inputs);

  // What is done before the next frame; tells whether anything was. A recorder, if any, gets it.
  bool act(weft::Simulation& simulation, weft::Recorder* recorder);

 private:
  void act_on_state(weft::Simulation& simulation, int kind);

  std::uint64_t seed_;
  Inputs inputs_;
  std::uint64_t step_ = 0;  // calls of act()
  double busy_ = 0;         // share of the frames with an input
  std::optional<weft::Snapshot> kept_;
};

}  // namespace fuzz
