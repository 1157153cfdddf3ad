// What runs a scene with an asked error (weft/tolerance.h).
#include "weft/tolerance.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tolerance/search.h"

namespace weft {
namespace {

constexpr double kFar = 1e3;  // m; an error beyond this tells nothing

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

std::string grids_words(const std::vector<Intervals>& grids) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t c = 0; c < std::min(grids.size(), kShown); ++c)
    text += (c > 0 ? ", " : "") + std::to_string(grids[c].u + 1) + " x " +
            std::to_string(grids[c].v + 1);
  return text + (grids.size() > kShown ? ", ..." : "") + " points, ";
}

}  // namespace

Choice choose(const Scene& scene, const Tolerance& tolerance, const Options& options) {
  if (std::vector<Fault> faults = validate(scene); !faults.empty())
    throw SceneError(std::move(faults));
  require(scene.solver.method != Method::positional,
          "method positional converges to no motion of springs");
  Options quiet = options;
  quiet.profile = quiet.follow_strain = false;
  constexpr double kMostFrames = 1e7;
  const double count = tolerance.seconds / scene.time.frame;
  require(tolerance.error > 0 && std::isfinite(tolerance.error), "the error is not above 0 m");
  require(count >= 0 && count <= kMostFrames, "the run has more than ten million frames");
  const int frames = std::max(1, int(std::lround(count)));
  const tolerance::Asked asked{scene, tolerance.error, {frames, quiet, tolerance.on_run}};
  if (!tolerance.grids) return tolerance::choose_substeps(asked);
  for (const Cloth& cloth : scene.cloths) {
    require(!cloth.mesh.given(), "a cloth is a mesh, which has no other resolution");
    require(cloth.level == 0, "a cloth has a level, whose constraints stand for no sheet");
  }
  return tolerance::choose_grids(asked);
}

std::string to_text(const Trial& trial) {
  char text[160];
  std::snprintf(text, sizeof text, "%s%d substeps a frame: error %.1e m",
                trial.intervals.empty() ? "" : grids_words(trial.intervals).c_str(), trial.substeps,
                trial.error);
  return text;
}

std::string to_text(const Choice& choice, const Tolerance& tolerance) {
  char line[240];
  std::snprintf(line, sizeof line, "tolerance %.3g m, tried on %.3g s\n", tolerance.error,
                choice.tried);
  std::string text = line;
  for (std::size_t n = 0; n < choice.trials.size(); ++n) {
    const Trial& t = choice.trials[n];
    const bool seen = t.why.empty() && t.error < kFar;
    std::snprintf(line, sizeof line, "%c %-24s  %s", int(n) == choice.best ? '*' : ' ',
                  t.method.c_str(),
                  seen            ? to_text(t).c_str()
                  : t.why.empty() ? "not stable as asked"
                                  : t.why.c_str());
    text += line;
    std::snprintf(line, sizeof line, ", work %.2g", t.work);
    text += (t.kept ? line : "") + std::string("\n");
  }
  const double run = choice.best < 0 ? 0 : choice.trials[std::size_t(choice.best)].work;
  if (run > 0) {
    std::snprintf(line, sizeof line, "the trials took %.2g times the work of the run\n",
                  choice.trial_work / run);
    text += line;
  }
  return text;
}

}  // namespace weft
