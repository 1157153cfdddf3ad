// What must hold in every frame, besides that nothing crashes.
#pragma once

#include <optional>
#include <vector>

#include "failure.h"
#include "laws.h"
#include "weft/simulation.h"

namespace fuzz {

// Values are finite, view() and report() agree with themselves, held particles stay where they are.
// Throws Failure.
class Judges {
 public:
  // The simulation stands at its start.
  explicit Judges(const weft::Simulation& simulation);

  // After a frame; `touched`: after an input, so that the scene alone tells no longer where pins are
  // and what energy there is.
  void frame(const weft::Simulation& simulation, bool touched);

  // The end of a run. Measures contacts as well.
  void end(const weft::Simulation& simulation) const;

 private:
  struct Held {             // a particle without a path
    std::size_t cloth, at;  // index into the view's arrays
    std::array<float, 3> place;
  };
  std::vector<Held> held_;
  std::optional<Laws> laws_;  // until the first input
};

}  // namespace fuzz
