// Makes a scene that fails smaller, as long as it fails the same way.
#pragma once

#include <functional>
#include <string>

#include "run.h"

namespace fuzz {

// What becomes of a case: "ok", or the failure.
using Trial = std::function<std::string(const Case&)>;

// The kind of a failure: what its text says before the first colon.
std::string kind_of(const std::string& answer);

// Leaves out inputs and whatever else of the scene is not needed for a failure of the same kind, and
// rounds numbers. `tell` gets what is reached so far.
Case minimised(const Case& c, const Trial& trial, const std::function<void(const Case&)>& tell);

}  // namespace fuzz
