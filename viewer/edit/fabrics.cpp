// The table of fabrics.
#include "edit/fabrics.h"

namespace weft::viewer {

const std::array<Fabric, 5> kFabrics{{
    {"silk", 0.06, 5000, 20, 3e-6, 0.25},
    {"cotton", 0.14, 6000, 55, 7e-6, 0.4},
    {"wool", 0.25, 4000, 40, 1.2e-5, 0.45},
    {"denim", 0.40, 7000, 110, 1.8e-5, 0.5},
    {"leather", 0.80, 20000, 6000, 1.7e-3, 0.55},
}};

std::vector<Document::Change> changes_to(const Fabric& fabric, std::size_t cloth, bool mesh) {
  const std::string place = "/cloths/" + std::to_string(cloth);
  if (mesh)
    return {{place + "/density", fabric.weight},
            {place + "/stiffness/structural", fabric.tensile},
            {place + "/bending", fabric.rigidity},
            {place + "/self_collision/friction", fabric.friction}};
  return {{place + "/density", fabric.weight},
          {place + "/particle_mass", 0.0},
          {place + "/masses", text::Json::array()},
          {place + "/level", 0},
          {place + "/stiffness/structural", fabric.tensile - fabric.shear},
          {place + "/stiffness/shear", fabric.shear},
          {place + "/stiffness/bend", 0.0},
          {place + "/bending", fabric.rigidity},
          {place + "/self_collision/friction", fabric.friction}};
}

}  // namespace weft::viewer
