// `weft run --tolerance E`: method, substeps and sweeps for an asked error.
//
// Every method that converges to the motion of the scene's springs is tried on the first quarter of a
// second: with so many substeps, and with twice as many. From the distance d of the two, the error of
// the first is d 2^p/(2^p - 1), p the order of the method (Richardson). Of all that keep the asked
// error the one with the least work is taken; work is counted, not timed, so that the choice is the
// same on every machine.
#pragma once

#include <string>
#include <vector>

#include "weft/simulation.h"

namespace weft::cli {

struct Trial {
  std::string method;  // "compliant, line, order 2"
  Solver solver;
  int substeps = 0;  // a frame
  double error = 0;  // m, root mean square over the particles at the end of the trial
  double work = 0;   // spring evaluations a frame, or as many others as cost the same
};

struct Choice {
  std::vector<Trial>
      trials;          // the last of every method: the first that keeps the error, if any does
  int best = -1;       // of those, the one to take; -1: none keeps the error
  double seconds = 0;  // s, of motion tried
};

// Tries on the scene's first `seconds` at most; `tolerance` in m.
Choice choose_solver(const Scene& scene, double tolerance, double seconds, const Options& options);

// What was tried, and what is taken: a line each.
std::string to_text(const Choice& choice, double tolerance);

}  // namespace weft::cli
