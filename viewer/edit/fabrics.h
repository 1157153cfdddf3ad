// Fabrics by name: weight, stiffness and bending rigidity, put into a cloth's values.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "edit/document.h"

namespace weft::viewer {

// Typical values; docs/viewer.md names the sources.
struct Fabric {
  std::string_view name;
  double weight;    // kg/m²
  double tensile;   // N/m, along the threads, at the small strains of drape
  double shear;     // N/m, per radian of the angle between the threads
  double rigidity;  // N·m, flexural, for a width of one metre
  double friction;  // of the fabric on itself
};
extern const std::array<Fabric, 5> kFabrics;

// The changes that make a cloth of the scene that fabric. Of a square grid of springs kn along the
// threads and kd across, C11 = kn + kd and C66 = kd; no bending springs. A mesh has springs along its edges alone,
// which carry the stretch along the threads.
std::vector<Document::Change> changes_to(const Fabric& fabric, std::size_t cloth, bool mesh);

}  // namespace weft::viewer
