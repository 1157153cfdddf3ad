// A failure that ends the program with one of the contract's exit codes.
#pragma once

#include <stdexcept>
#include <string>

namespace weft::viewer {

enum ExitCode {
  kDone = 0,
  kBadCommandLine = 2,
  kBadScene = 3,
  kStopped = 4,
  kCannotWrite = 5,
  kNoGraphics = 6
};

struct Failure : std::runtime_error {
  Failure(ExitCode exit_code, const std::string& text)
      : std::runtime_error(text), code(exit_code) {}
  ExitCode code;
};

}  // namespace weft::viewer
