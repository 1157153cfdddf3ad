// What bodies answer while contact among sheets is solved.
//
// Bodies answer the motion of a substep before sheets do. What sheets then do to each other, bodies would learn of a
// substep later: until then they have pressed what lies on bodies into them, and dragged it along. So bodies take
// part in the sweeps: a particle on one, or near it, is kept out of it, and rubbed by as much as this presses, with
// impulses that begin as they were in the run before (sequential impulses: Catto 2005).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/kernels/contact.h"
#include "physics/model/placement.h"
#include "physics/step/threads.h"
#include "weft/scene.h"

namespace weft::physics {

struct ContactInterval;

class BodyAnswer {
 public:
  // `scene` lives longer; `reach`: how near a body is asked [m].
  BodyAnswer(const Scene& scene, double reach);

  // Whether the scene has a body to lie on.
  bool given() const { return !colliders_.empty(); }
  // Of these particles of contacts, each once and in order: those near a body, by where they are and how far they have
  // moved in the interval.
  void find(std::span<const std::int32_t> particles, const Place* now, const Displacement* moved,
            const ContactInterval& interval, Threads& threads);
  // Adds the impulses of the run before to how far contact moves particles.
  void begin(Displacement* change) const;
  // One sweep; returns its greatest correction [m].
  float sweep(Displacement* change);
  // What positions alone are moved by leads into no body.
  void keep_out(Displacement* lift) const;
  void forget() { near_.clear(); }
  void keep(Keeper& keeper);
  std::size_t bytes() const;

 private:
  // A particle near a body; one near several is there several times, in the order of bodies.
  struct Near {
    std::int32_t particle, body;
    float gap;                 // m
    float normal[3];           // out of the body
    float slid[3];             // how far it has moved against the body [m]
    float statik, dynamic;     // friction
    float pressed, rubbed[3];  // impulses, as displacements [m]
  };
  // A body as it stands at the interval's end, and how it came there.
  struct Body {
    const Collider* collider;
    Placement placement;
    RigidMotion motion;
  };
  bool is_near(const Body& body, const Place& now, const Displacement& moved,
               const ContactInterval& interval, Near& near) const;
  void place_bodies(const ContactInterval& interval);

  const Scene& scene_;
  double reach_;
  std::vector<std::size_t> colliders_;
  std::vector<Body> bodies_;
  std::vector<std::vector<Near>> found_;  // of parts of the particles
  std::vector<Near> near_, before_;
  double seconds_ = 1;
};

}  // namespace weft::physics
