// Sheets of cloth whose state has a limit as their grid gets finer, each with its limit (bench/continuum).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "problems.h"

namespace bench {

struct Sheet {
  std::string name;
  std::string about;  // what happens to which fabric, one sentence
  double seconds = 0;
  std::vector<int> sizes;                // points along u that are worth their time
  std::function<weft::Scene(int)> make;  // of so many points along u
  // Springs that stand for its membrane to first order in strain, for solvers that know nothing else; none:
  // they cannot.
  std::optional<weft::Kinds> springs{};
  std::string without_bullet{};  // why Bullet is left out; "": it takes part
  // The limit at the points of a grid, where it is known by other means; none: from ever finer grids.
  std::function<std::vector<double>(const weft::Grid&)> limit{};
  double limit_error = 0;  // m
  int middle = 0;    // points along u of the middle one of the three grids that tell the limit
  double known = 0;  // m; RMS error at which the reference may stop halving its substep
  int halvings = 2;  // and after how many halvings it does in any case
};

const std::vector<Sheet>& sheets();

Problem problem_of(const Sheet& sheet, int points);

// What it tends to as the grid gets finer.
struct Truth {
  std::function<std::vector<double>(const weft::Grid&)> at;  // of one of the sheet's grids
  double error = 0;                                          // m, RMS
  std::string how;                                           // one sentence: from what it is known
};

// From three grids of double the points each: what the last doubling changes, divided by 2^order - 1, is left to
// the limit, with the order that the three show, from 1 to 2. Its error is the distance to the limit of the two
// coarser grids by the same order, over 2^order, plus the references' own.
Truth truth_of(const Sheet& sheet, const std::string& cache);

}  // namespace bench
