// Use that a library must stand: snapshots that are broken, states that are no numbers, particles that
// are not there. Throws Failure where a call neither works nor refuses as its header says.
#pragma once

#include "run.h"

namespace fuzz {

void mistreat(const Case& c, const weft::Options& options, int rounds);

}  // namespace fuzz
