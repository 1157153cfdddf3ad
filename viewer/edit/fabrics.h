// Fabrics (weft/fabric.h) put into the values of a cloth.
#pragma once

#include <vector>

#include "edit/document.h"
#include "weft/fabric.h"

namespace weft::viewer {

// The changes that make every cloth of the scene of that fabric, and of these colours.
std::vector<Document::Change> changes_to(const Fabric& fabric, const ClothColor& color,
                                         const Scene& scene);

}  // namespace weft::viewer
