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
  t.why.clear();
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
  trial.why = "not stable as asked";
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
  constexpr int kRungs = 6, kEnough = 4;
  // Substeps below the stability limit show an order of 1, whatever the sheet touches.
  constexpr double kLeastOrder = 0.7;
  Search search{trial_of(way)};
  Ladder ladder(way.order, kLeastOrder);
  int first = first_substeps(asked.scene, way, asked.runs.options);
  for (int n = first; ladder.rungs() < kRungs && n <= 2 * kMostSubsteps; n *= 2) {
    Motion motion = motion_of(asked.scene, way, n, asked.runs);
    if (motion.refused) break;
    search.work += motion.work;
    if (motion.places.empty()) {  // sheets that are stretched need finer ones
      first = 2 * n;
      continue;
    }
    ladder.add(std::move(motion));
    put(search, ladder, n, first, asked.error);
    if (search.trial.kept || (ladder.rungs() >= kEnough && !ladder.falls())) break;
  }
  truth = {ladder.finest(), ladder.error()};
  return search;
}

Search find_against(const Asked& asked, const Way& way, const Truth& truth, double most_work) {
  Search search{trial_of(way)};
  Trial& t = search.trial;
  if (truth.error >= asked.error) {
    t.why = "cannot be measured so finely";
    return search;
  }
  for (int n = 1; n <= kMostSubsteps; n *= 2) {
    const Motion motion = motion_of(asked.scene, way, n, asked.runs);
    if (motion.refused) return search;
    search.work += motion.work;
    t.why.clear();
    t.substeps = n, t.work = motion.work;
    t.error = distance(motion, truth.motion) + truth.error;
    t.kept = t.error <= asked.error;
    if (t.kept || 2 * t.work >= most_work) return search;
  }
  return search;
}

Search find_implicit(const Asked& asked, const Way& way, double most_work) {
  constexpr int kLeastRungs = 4;  // before an order is seen twice
  Search search{trial_of(way)};
  if (!way.damps) {
    search.trial.why = "leaves damping out";
    return search;
  }
  Ladder ladder(way.order);
  for (int n = 1; n <= kMostSubsteps; n *= 2) {
    Motion motion = motion_of(asked.scene, way, n, asked.runs);
    if (motion.refused) return search;
    search.work += motion.work;
    ladder.add(std::move(motion));
    put(search, ladder, n, 1, asked.error);
    search.trial.kept = search.trial.kept && ladder.rungs() >= kLeastRungs;
    if (search.trial.kept || ladder.finest().work / 2 >= most_work) break;
  }
  return search;
}

std::string not_promised(const Asked& asked, const Search& search, const std::string& finer) {
  const Trial& t = search.trial;
  std::string note = "the error of " + short_words(asked.error) + " m is not promised: ";
  if (!t.why.empty()) return note + t.method + ": " + t.why;
  if (!std::isfinite(t.error)) return note + t.method + " is not stable over the whole run";
  if (!search.falls)
    return note + "with ever finer " + finer + " of " + t.method +
           " positions go on changing, by some " + short_words(t.error) +
           " m at last: the motion is chaotic" +
           (finer == "substeps" ? "" : ", or has no limit, as of sheets held at points");
  return note + t.method + " is " + short_words(t.error) + " m off with the finest " + finer +
         " that were tried";
}

}  // namespace weft::tolerance
