// A run of a scene by one way, and where its particles came.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tolerance/ways.h"
#include "weft/resolution.h"
#include "weft/simulation.h"

namespace weft::tolerance {

// Places at a few instants spread over a run; none where the way does not run the scene as asked.
struct Motion {
  bool refused = false;                     // by validate(), with this way
  int substeps = 0;                         // a frame
  double work = 0;                          // Trial::work
  std::vector<Intervals> grids;             // of every cloth; a mesh is one row
  std::vector<std::vector<double>> places;  // at each instant x,y,z of every particle
};

// How trials are run.
struct Runs {
  int frames;
  Options options;
  std::function<void(const std::string&)> on_run;  // Tolerance::on_run
};

// `substeps`: a frame, or kAutoSubsteps.
Motion motion_of(const Scene& scene, const Way& way, int substeps, const Runs& runs);

// How far two runs of equal length are apart at the particles of the first [m]: the root mean square over a cloth, of
// the cloth and at the instant where it is greatest. The second's grids have all particles of the first's. Infinite where one was not run.
double distance(const Motion& coarse, const Motion& fine);

}  // namespace weft::tolerance
