// What a run needs, as check and explain say it, and the refusal of what cannot fit into memory.
#pragma once

#include <string>

#include "weft/estimate.h"

namespace weft::cli {

// "needs about 1.2 GB of memory and 3 s a frame on one thread …", and a note for what is more than
// the machine has, or than two minutes for a whole run: a line each.
std::string needs_words(const Estimate& needed);

// Throws a Failure that names what the scene needs and what there is where even the least of the
// estimate is more than the free memory. `place` as error lines name it.
void require_memory(const Scene& scene, const std::string& place);

}  // namespace weft::cli
