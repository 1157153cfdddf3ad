// What a scene is found guilty of.
#pragma once

#include <stdexcept>

namespace fuzz {

// what() begins with the kind of failure and a colon: "difference: …", "judge pins: …".
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace fuzz
