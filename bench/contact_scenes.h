// Scenes that try contact among sheets: shipped ones by name, and others that are made here.
#pragma once

#include <string>
#include <vector>

#include "weft/scene.h"

namespace bench {

struct ContactScene {
  std::string name, about;
};

// All of them, in the order in which they are listed.
const std::vector<ContactScene>& contact_scenes();

// One of them. ppf_hang, ppf_drape, ppf_curtain and ppf_twist are like scenes of ppf-contact-solver: sheets of
// 1 kg/m², structural 1000 and shear 500 N/m (hang: 100 and 50; twist: a membrane that they amount to),
// bending 1e-3 N·m (hang: 1e-4), no friction, thickness 1 mm, no drag, a strain limit (but for twist).
// `jitter` [m] moves the particles of grids at the start.
// Throws std::invalid_argument for a name that is none of theirs.
weft::Scene contact_scene(const std::string& name, double jitter = 0);

}  // namespace bench
