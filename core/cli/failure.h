// How a command fails: an exit code and one line on standard error for each thing that is wrong.
#pragma once

#include <string>
#include <vector>

#include "weft/scene.h"

namespace weft::cli {

inline constexpr int kDone = 0;
inline constexpr int kBadCommandLine = 2;
inline constexpr int kBadScene = 3;
inline constexpr int kStopped = 4;
inline constexpr int kNotWritten = 5;

// Thrown by a command that cannot go on. The place of a fault is an option, a file, or a file and
// the JSON pointer into it.
struct Failure {
  int exit_code;
  std::vector<Fault> faults;
};

// `weft: error: PLACE: what (allowed)`, a line for each fault.
void print(const std::vector<Fault>& faults);

// "a, b, c"
std::string list(const std::vector<std::string>& words);

}  // namespace weft::cli
