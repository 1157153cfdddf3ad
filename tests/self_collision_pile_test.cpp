// A sheet that falls on a body and on itself: whatever presses it against the body takes energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "cases.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

// The course's sheet of 150 kg/m², whose lowest row bears all others that have fallen on it.
Scene falling(const std::string& ks, SelfCollisionResponse response, double limit) {
  Scene scene = read_scene("selfCollision", {{"/cloth/ks", ks}}).scene;
  scene.cloths[0].self_collision.response = response;
  scene.cloths[0].strain_limit = limit;
  return scene;
}

// The most by which the energy of all rises within a frame, of that at the start.
double greatest_gain(const Scene& scene) {
  Simulation run(scene, {.threads = 1});
  const double start = run.report(false).energy.total;
  double most = 0, before = start;
  for (int frame = 0; frame < 75; ++frame) {
    run.advance_frame();
    const double now = run.report(false).energy.total;
    most = std::max(most, now - before);
    before = now;
  }
  return most / start;
}

TEST(Pile, GainsNoEnergyOnAnyBodyByAnyFriction) {
  const Plane plane{{0, 0, 0}, {0, 1, 0}};
  const Sphere sphere{{0.5, -5, 0}, 5};
  const Box box{{0.5, -0.1, 0}, {2, 0.1, 2}, {}, 0};
  for (const Shape& shape : {Shape(plane), Shape(sphere), Shape(box)})
    for (const Friction& friction :
         {Friction{FrictionModel::course, 0, 0}, Friction{FrictionModel::course, 0.5, 0.5},
          Friction{FrictionModel::coulomb, 0.5, 0.5}}) {
      Scene scene = falling("1000", SelfCollisionResponse::stiff, 0);
      scene.colliders[0].shape = shape;
      scene.colliders[0].friction = friction;
      EXPECT_LT(greatest_gain(scene), 0.01) << "body " << shape.index() << ", friction "
                                            << int(friction.model) << " " << friction.dynamic;
    }
}

TEST(Pile, GainsNoEnergyHoweverSoftTheSheetIs) {
  Cases cases(5);
  for (const char* ks : {"500", "2000", "5000", "20000"})
    for (const auto response : {SelfCollisionResponse::stiff, SelfCollisionResponse::neighbours,
                                SelfCollisionResponse::course})
      for (const double limit : {0.0, 0.1}) {
        if (!cases.next()) continue;
        EXPECT_LT(greatest_gain(falling(ks, response, limit)), 0.02)
            << "ks " << ks << ", response " << int(response) << ", limit " << limit;
      }
}

}  // namespace
}  // namespace weft
