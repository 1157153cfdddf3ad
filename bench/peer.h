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

// A solver as the seeds describe it: point-mass and spring objects, forces gathered spring by spring
// (or ends moved, method positional), Verlet with the last position, doubles, one thread. Particles
// inside a sphere are put onto it. Neither tears nor bends by curvature.
class CoursePeer : public Peer {
 public:
  virtual std::vector<double> velocities() const = 0;
  virtual void set_state(const std::vector<double>& positions,
                         const std::vector<double>& velocities) = 0;
};
std::unique_ptr<CoursePeer> make_course_peer(const weft::Scene& scene, int substeps);

// Bullet's classical soft body (libbullet); null when the program was built without it.
std::unique_ptr<Peer> make_bullet_peer(const weft::Scene& scene, int substeps);

}  // namespace bench
