// What is odd about how cloths start, and what is done about it.
#pragma once

#include <string>
#include <vector>

#include "physics/frame/cloth_step.h"
#include "physics/frame/sheet_contact.h"

namespace weft::physics {

// Adds a note for each of: gravity on keys; cloths that start inside of colliders; thicknesses that let
// particles pass; pins that start far from their places; cuts that cut nothing; sheets that start too near to
// each other or cross. `contact`: or null.
void note_starts(const Scene& scene, const Cloths& cloths, SheetContact* contact,
                 std::vector<std::string>& notes);

}  // namespace weft::physics
