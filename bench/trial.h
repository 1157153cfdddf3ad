// One measurement: a problem run with one setting, instruction set and thread count.
#pragma once

#include <string>
#include <vector>

#include "problems.h"
#include "weft/simulation.h"

namespace bench {

struct Trial {
  std::string problem;  // name
  int size = 0;
  Setting setting;
  std::string simd;
  int threads = 1;
  int substeps = 0;     // per frame, as run at the end
  double setup_ms = 0;  // building the simulation
  double run_ms = 0;    // the whole run, the fastest repetition
  // The sum over frames of each frame's fastest repetition: the run as it would be if nothing else
  // ran on the machine.
  double quiet_ms = 0;
  int repetitions = 0;
  double rms = 0;         // m; or the greatest strain at the end, where the problem measures strain
  double greatest = 0;    // m; or the greatest strain of any frame
  std::string note;       // why there is no figure: not in this build, stopped itself; "" = fine
  bool on_front = false;  // no other trial of its problem is both faster and more accurate

  bool ok() const { return note.empty(); }
  int frames = 0;
};

// How often to repeat: until `seconds` have been spent, at least `least`, at most `most` times.
struct Repeats {
  double seconds = 1;
  int least = 3, most = 30;
};

Trial run_trial(const Problem& problem, const Setting& setting, weft::Simd simd, int threads,
                const std::vector<double>& truth, const Repeats& repeats);

// Marks the trials that no other trial of the same problem, and of the same size or of any, beats in both time and
// error.
void mark_front(std::vector<Trial>& trials, bool any_size = false);

}  // namespace bench
