// One row of the accuracy page: a law, a case of it, what is true, what came out. Each row is
// printed as a line that bench/accuracy_table collects into docs/accuracy.md.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace weft {

struct Truth {
  std::string law;   // "hanging column": rows of one law stand together
  std::string what;  // the case: "spring, 1 ms"
  double truth = 0;
  double goal = 0;   // greatest error that counts as met; relative, or absolute where truth is 0
  std::string unit;  // of truth and result
};

// Prints the row and returns the size of its error.
inline double show(const Truth& t, double result) {
  const double error = t.truth == 0 ? result : result / t.truth - 1;
  std::printf("@ %s | %s | %.6g | %.6g | %s | %+.2e | %.4g\n", t.law.c_str(), t.what.c_str(),
              t.truth, result, t.unit.c_str(), error, t.goal);
  return std::abs(error);
}

// The same, and the test fails where the goal is missed.
inline double expect(const Truth& t, double result) {
  const double error = show(t, result);
  EXPECT_LE(error, t.goal) << t.law << ", " << t.what;
  return error;
}

// A finding that is an order: the result is to be above the truth, which is what another case came
// to or a bound that is not 0, by the goal's share of it at least.
inline void expect_above(const Truth& t, double result) {
  const double margin = result / t.truth - 1;
  std::printf("@ %s | %s | > %.6g | %.6g | %s | %+.2e | %.4g\n", t.law.c_str(), t.what.c_str(),
              t.truth, result, t.unit.c_str(), margin, t.goal);
  EXPECT_GE(margin, t.goal) << t.law << ", " << t.what;
}

}  // namespace weft
