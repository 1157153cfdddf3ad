// One scene looked at from all sides.
#pragma once

#include "run.h"

namespace fuzz {

// Which runs of a scene are compared.
enum class Variants {
  all,  // every instruction set of this machine, one to three threads, a replay, a restored snapshot
  one,  // the instruction set and threads that the seed's number picks: for logs that are compared
};

// The hash of the whole run, the same whatever runs it. Files go to `folder`. Throws Failure, and
// what the library throws where it should not.
std::uint64_t examine(const Case& c, Variants variants, const std::string& folder);

// The case of a seed.
Case case_of(std::uint64_t seed);

}  // namespace fuzz
