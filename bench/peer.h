// Other ways to simulate the same sheet, driven frame by frame like a Simulation.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "weft/scene.h"

namespace bench {

class Peer {
 public:
  virtual ~Peer() = default;
  virtual void advance_frame() = 0;
  virtual std::vector<double> positions() const = 0;  // x,y,z in scene order
};

// A solver as the course of seeds 001 and 004 describes it: point-mass and spring objects, forces
// gathered spring by spring, Verlet with the last position, doubles, one thread.
std::unique_ptr<Peer> make_course_peer(const weft::Scene& scene, int substeps);

// Bullet's classical soft body (libbullet); null when the program was built without it.
std::unique_ptr<Peer> make_bullet_peer(const weft::Scene& scene, int substeps);

}  // namespace bench
