// Method and substeps for an asked error over a whole run (search.h).
#include <algorithm>
#include <cmath>

#include "tolerance/search.h"

namespace weft::tolerance {

// Errors of implicit ways are measured against the explicit one, where that takes no more work than it is worth: their
// own ladders have plateaus, on which neighbours hardly differ though all of them have smoothed fast motion away.
Choice choose_substeps(const Asked& asked) {
  Choice choice;
  choice.scene = asked.scene;
  choice.tried = asked.runs.frames * asked.scene.time.frame;
  const std::vector<Way> ways = ways_of(asked.scene);
  const Way& first = ways.front();
  std::vector<Search> all;
  Truth truth;
  bool chaotic = false;
  if (first_substeps(asked.scene, first, asked.runs.options) <= kMostOfTruth) {
    all.push_back(find_explicit(asked, first, truth));
    chaotic = !all.back().falls;
  }
  const bool measured = std::isfinite(truth.error);
  double least = all.empty() || !all.front().trial.kept ? kAnyWork : all.front().trial.work;
  for (std::size_t n = 1; n < ways.size() && !chaotic; ++n) {
    all.push_back(measured ? find_against(asked, ways[n], truth, least)
                           : find_implicit(asked, ways[n], least));
    if (all.back().trial.kept) least = std::min(least, all.back().trial.work);
  }
  const auto kept = [](const Search& s) { return s.trial.kept; };
  const auto is_first = [&](const Search& s) { return s.trial.method == first.name; };
  if (std::ranges::none_of(all, is_first) && std::ranges::none_of(all, kept))
    all.push_back(find_explicit(asked, first, truth));

  for (const Search& s : all) {
    choice.trial_work += s.work;
    choice.trials.push_back(s.trial);
    if (s.trial.kept && s.trial.work <= least)
      least = s.trial.work, choice.best = int(choice.trials.size()) - 1;
  }
  // Where nothing is promised, the nearest that was tried runs, and the note says how near that is.
  choice.promised = choice.best >= 0;
  const auto error = [](const Search& s) { return s.trial.error; };
  const auto nearest = std::ranges::min_element(all, {}, error);
  if (!choice.promised) choice.notes.push_back(not_promised(asked, *nearest, "substeps"));
  const Trial& taken = choice.promised ? choice.trials[std::size_t(choice.best)] : nearest->trial;
  if (taken.substeps == 0 || !std::isfinite(taken.error)) return choice;
  choice.scene.solver = taken.solver;
  choice.scene.time.substeps = taken.substeps;
  return choice;
}

}  // namespace weft::tolerance
