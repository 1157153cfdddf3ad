// What a scene is found guilty of.
#pragma once

#include <stdexcept>
#include <string>

namespace fuzz {

// `kind` is one word or two ("difference", "judge energy"), by which failures are told apart; what()
// begins with it.
struct Failure : std::runtime_error {
  Failure(const std::string& its_kind, const std::string& text)
      : std::runtime_error(its_kind + ": " + text), kind(its_kind) {}
  std::string kind;
};

}  // namespace fuzz
