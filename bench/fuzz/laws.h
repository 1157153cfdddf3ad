// Laws of physics that a run keeps where its scene is simple enough to tell: energy, momentum, planes,
// pins on paths. docs/fuzzing.md says which scenes are judged by what, and which are left out.
#pragma once

#include <list>
#include <vector>

#include "../energy_ledger.h"

namespace fuzz {

class Laws {
 public:
  // The simulation stands at its start; nobody touches it afterwards.
  explicit Laws(const weft::Simulation& simulation);

  // After a frame. Throws Failure.
  void frame(const weft::Simulation& simulation);

 private:
  void open_ledgers(const weft::Simulation& simulation);
  void check_energy(const weft::Simulation& simulation);
  void check_momentum(const weft::Simulation& simulation);
  void check_planes(const weft::Simulation& simulation) const;
  void check_paths(const weft::Simulation& simulation) const;

  std::list<bench::Ledger> ledgers_;  // one for each cloth, or none
  bool springs_;
  bool together_ = false;  // cloths meet each other, and pass energy on
  bool momentum_kept_;
  weft::Vec3 momentum_{};  // kg m/s, at the start
  double flow_ = 0;        // kg m/s, the greatest Σ m|v| so far
  bool above_planes_;
};

}  // namespace fuzz
