// The problems that accuracy is measured on, and the solver settings that are tried on each.
#pragma once

#include <string>
#include <vector>

#include "reference.h"
#include "weft/scene.h"

namespace bench {

// What a run's error is.
enum class Measure {
  distance,  // of the final positions from the reference
  strain,    // greatest structural strain: the truth is an inextensible sheet
};

struct Problem {
  std::string name;   // "swing"
  std::string about;  // one line
  int size = 0;       // N of the N x N sheet
  Measure measure = Measure::distance;
  Question question;
  // What the project asks of method `spring` with automatic substeps on one thread; 0 = nothing.
  double target_ms = 0, target_error = 0;

  std::string title() const { return name + " N=" + std::to_string(size); }
};

// The problems by these names, each at its usual sizes or at `size` when that is > 0; throws
// std::invalid_argument for an unknown name.
std::vector<Problem> problems_named(const std::vector<std::string>& names, int size);
std::vector<std::string> problem_names();

struct Setting {
  std::string method;  // what is compared: "compliant line 2nd order"
  weft::Solver solver;
  int substeps = weft::kAutoSubsteps;  // per frame
  double frame = 0;                    // s; 0: the problem's

  // "16 substeps, 4 sweeps"
  std::string text() const;
};

// All settings worth trying on a problem, method by method. `quick` leaves out those that take long
// and show little.
std::vector<Setting> settings_for(const Problem& problem, bool quick);

}  // namespace bench
