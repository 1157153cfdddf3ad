// Vertices of a cloth that lie on each other without being one.
#pragma once

#include <string>
#include <vector>

#include "weft/scene.h"

namespace weft::text {

// Notes vertices of faces that lie in exactly one place with others and that no seam joins to them, as of files
// whose triangles have corners of their own: there the cloth is in pieces. `cloth`: its mesh is read. `place`: of
// the cloth.
void note_unjoined(const Cloth& cloth, const std::string& place, std::vector<std::string>& notes);

}  // namespace weft::text
