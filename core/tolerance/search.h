// The search for what keeps an asked error at least work.
#pragma once

#include <limits>
#include <string>

#include "tolerance/ladder.h"
#include "tolerance/ways.h"
#include "weft/tolerance.h"

namespace weft::tolerance {

struct Asked {
  const Scene& scene;
  double error;  // m
  Runs runs;
};

// A trial of one way.
struct Search {
  Trial trial;
  double work = 0;    // of all its runs
  bool falls = true;  // Ladder::falls(), at its end
};

// What others are measured against.
struct Truth {
  Motion motion;
  double error = std::numeric_limits<double>::infinity();  // m; its own
};

constexpr double kAnyWork = std::numeric_limits<double>::infinity();

Trial trial_of(const Way& way);

// The stability limit's substeps.
int first_substeps(const Scene& scene, const Way& way, const Options& options);

// Whether an explicit way with so many substeps at the stability limit may serve as a truth: beyond that, sheets are
// so stiff that lines take a hundredth of the work.
constexpr int kMostOfTruth = 512;

// On the scene's own grids.
//
// Substeps of an explicit way from the stability limit on, doubled until the error is kept; what is seen by then is a
// truth for others.
Search find_explicit(const Asked& asked, const Way& way, Truth& truth);
// Of an implicit way from one on, doubled until the distance from the truth keeps the error, or no less than
// `most_work` is needed.
Search find_against(const Asked& asked, const Way& way, const Truth& truth, double most_work);
// The same without a truth, by how far they are apart.
Search find_implicit(const Asked& asked, const Way& way, double most_work);

// By substeps alone; by substeps and grids.
Choice choose_substeps(const Asked& asked);
Choice choose_grids(const Asked& asked);

// What a choice says where it promises nothing.
std::string not_promised(const Asked& asked, const Search& search, const std::string& finer);

}  // namespace weft::tolerance
