// One way's substeps for an asked error (search.h).
#include "tolerance/search.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace weft::tolerance {
namespace {

constexpr int kMostSubsteps = 4096;  // a frame

std::string short_words(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", x);
  return text;
}

// What a ladder of substeps tells, its finest rung having n.
void put(Search& search, const Ladder& ladder, int n, int least, double error) {
  Trial& t = search.trial;
  const std::optional<double> times = ladder.needed(error);
  t.kept = times.has_value();
  t.substeps = times ? std::max(least, int(std::ceil(*times * n))) : n;
  t.error = ladder.error(double(t.substeps) / n);
  t.order = ladder.order();
  t.work = ladder.finest().work / n * t.substeps;
  search.falls = ladder.falls();
}

}  // namespace

Trial trial_of(const Way& way) {
  Trial trial;
  trial.error = std::numeric_limits<double>::infinity();
  trial.method = way.name;
  trial.solver = way.solver;
  return trial;
}

int first_substeps(const Scene& scene, const Way& way, const Options& options) {
  Scene tried = scene;
  tried.solver = way.solver;
  tried.time.substeps = kAutoSubsteps;
  return Simulation(tried, options).substeps();
}

Search find_explicit(const Asked& asked, const Way& way, Truth& truth) {
  constexpr int kRungs = 4;
  Search search{trial_of(way)};
  // Substeps below the stability limit show an order of 1 at least, whatever the sheet touches.
  Ladder ladder(way.order, 1);
  int first = first_substeps(asked.scene, way, asked.runs.options);
  for (int n = first; ladder.rungs() < kRungs && n <= 2 * kMostSubsteps; n *= 2) {
    Motion motion = motion_of(asked.scene, way, n, asked.runs);
    search.work += motion.work;
    if (motion.places.empty()) {  // sheets that are stretched need finer ones
      first = 2 * n;
      continue;
    }
    ladder.add(std::move(motion));
    put(search, ladder, n, first, asked.error);
    if (search.trial.kept) break;
  }
  truth = {ladder.finest(), ladder.error()};
  return search;
}

Search find_against(const Asked& asked, const Way& way, const Truth& truth, double most_work) {
  Search search{trial_of(way)};
  Trial& t = search.trial;
  for (t.substeps = 1; t.substeps <= kMostSubsteps; t.substeps *= 2) {
    const Motion motion = motion_of(asked.scene, way, t.substeps, asked.runs);
    search.work += t.work = motion.work;
    t.error = distance(motion, truth.motion) + truth.error;
    t.kept = t.error <= asked.error;
    if (t.kept || 2 * t.work >= most_work) return search;
  }
  t.substeps = kMostSubsteps;
  return search;
}

Search find_implicit(const Asked& asked, const Way& way, double most_work) {
  constexpr int kLeastRungs = 4;  // before an order is seen twice
  Search search{trial_of(way)};
  Ladder ladder(way.order);
  for (int n = 1; n <= kMostSubsteps; n *= 2) {
    ladder.add(motion_of(asked.scene, way, n, asked.runs));
    search.work += ladder.finest().work;
    put(search, ladder, n, 1, asked.error);
    search.trial.kept = search.trial.kept && ladder.rungs() >= kLeastRungs;
    if (search.trial.kept || ladder.finest().work >= most_work) break;
  }
  return search;
}

std::string not_promised(const Asked& asked, const Search& search, const std::string& finer) {
  const Trial& t = search.trial;
  std::string note = "the error of " + short_words(asked.error) + " m is not promised: ";
  if (!std::isfinite(t.error)) return note + t.method + " is not stable over the whole run";
  if (!search.falls)
    return note + "with ever finer " + finer + " of " + t.method +
           " positions go on changing, by " + short_words(t.error) +
           " m at last; the motion is chaotic" +
           (finer == "substeps" ? "" : ", or held at points, for which no sheet has a limit");
  return note + t.method + " is " + short_words(t.error) + " m off with the finest " + finer +
         " that were tried";
}

}  // namespace weft::tolerance
