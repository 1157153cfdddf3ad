// What runs a scene with an asked error at least work: method, substeps and, if asked, grids.
//
// Runs of ever finer substeps (and grids) over the whole length are compared, each with the next: from how far they
// are apart, and how that falls, follows the error of each and of finer ones (Richardson). What is picked is up to
// twice as fine as what was tried. Work is counted, not timed, so that the choice is the same on every machine.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "weft/resolution.h"
#include "weft/simulation.h"

namespace weft {

struct Tolerance {
  // m, above 0; of positions, root mean square over the particles of a cloth, at its greatest over cloths and the run.
  double error = 0.001;
  double seconds = 0;  // s, 0 or more; of the run, of up to ten million frames
  // Also picks the grids of all cloths, which are no meshes; the error is then that against the sheet behind them.
  bool grids = false;
  // Called before every run of the trials: "spring, 1089 particles, 44 substeps a frame". Or none.
  std::function<void(const std::string&)> on_run;
};

// What a way to solve the scene comes to.
struct Trial {
  std::string method;  // "compliant, line, order 2"
  Solver solver;
  int substeps = 0;                  // a frame
  std::vector<Intervals> intervals;  // of every cloth's grid, where grids are picked
  bool kept = false;                 // the error, by an estimate that can be trusted
  std::string why;                   // there are no figures; else empty
  double error = 0;                  // m; estimated
  double order = 0;                  // by which it falls with finer substeps or grids, as seen
  double work = 0;  // particles times substeps of springs that cost as much, over the run
};

struct Choice {
  std::vector<Trial> trials;
  // Of those, the one that `scene` is run by; -1: none keeps the error, and the nearest that was tried runs, if any of
  // them was stable.
  int best = -1;
  bool promised = false;  // over the whole run
  double tried = 0;  // s; what the trials went over: all of the run where the choice is promised
  double trial_work = 0;           // of all trials, counted as Trial::work is
  Scene scene;                     // to be run
  std::vector<std::string> notes;  // what is not promised and why; what is not quite as asked
};

// `options`: as the scene is to be run. Throws SceneError where the scene has faults; std::invalid_argument where the
// tolerance is out of range, and where no method converges to the scene's motion: method positional, or grids are
// asked for and a cloth is a mesh, or has a level.
Choice choose(const Scene& scene, const Tolerance& tolerance, const Options& options);

// "33 x 33 points, 44 substeps a frame: error 1.4e-03 m"; of grids that were not picked without points.
std::string to_text(const Trial& trial);

// What was tried, and what is taken: a line each.
std::string to_text(const Choice& choice, const Tolerance& tolerance);

}  // namespace weft
