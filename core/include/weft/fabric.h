// Fabrics by name: what a cloth of each weighs, and how it resists stretch, shear and bending. A scene names one
// with the key `fabric` of a cloth; a program puts one into a Cloth. docs/scenes.md has the sources of the values,
// and the drape coefficients that come of them.
#pragma once

#include <span>
#include <string_view>

#include "weft/scene.h"

namespace weft {

// A typical cloth of that name, at the small strains and curvatures of drape. Warp lies along u of a grid, or along
// the first texture coordinate of a mesh.
struct Fabric {
  std::string_view name;
  double weight;  // kg/m²
  // N/m: along warp and weft, coupling, and per radian of the angle between them; damping in s.
  Membrane membrane;
  // N·m, for a width of one metre: along warp and weft, and of twist; damping in s, of meshes.
  Bending bending;
  double friction;  // Coulomb, of the fabric on itself
};

// All that are known, from the lightest to the heaviest.
std::span<const Fabric> fabrics();

// Null where none has the name, which is in small letters.
const Fabric* find_fabric(std::string_view name);

// Makes a cloth of the fabric: its density, in place of masses of particles; membrane, in place of springs and levels;
// bending; and friction on itself. All else stays. Method positional has no membranes: on grids, springs stand for it,
// whose C11 and C66 are the same where the cloth is as stiff along the warp as along the weft, else a mean.
void make_of(const Fabric& fabric, Method method, Cloth& cloth);

}  // namespace weft
