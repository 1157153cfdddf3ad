// Friction that damps what moves along a surface, in a layer about it, against its closed forms.
#include "contact_scenes.h"
#include "truth.h"

namespace weft {
namespace {

// What flies along a surface within the bias, or rides on it, loses speed against it as exp(-c t); what is
// farther away, or moves straight at it, does not.
TEST(ValidationContact, TheLayerDampsWhatMovesAlongTheSurface) {
  constexpr std::size_t kOther = 12;  // of the second sheet
  constexpr double kDamping = 2, kBias = 0.1, kSeconds = 0.5;
  for (const Method method :
       {Method::spring, Method::spring_friction, Method::compliant, Method::positional})
    for (const double speed : {0.0, 0.75}) {  // of the plane
      Scene scene;
      scene.gravity = {};
      scene.time.substeps = 100;
      scene.solver.method = method;
      scene.cloths.push_back(loose_particles({0, 0.05, 0}));
      scene.cloths.push_back(loose_particles({0, 0.2, 0}));
      for (Cloth& cloth : scene.cloths) cloth.velocity = {3, 0.01, -4};
      scene.colliders.push_back(collider_of(Plane{}));
      scene.colliders[0].friction = {FrictionModel::coulomb, 0.5, 0.5, kDamping, kBias};
      if (speed > 0) scene.colliders[0].keys = {{0, {0, 0, 0}}, {10, {10 * speed, 0, 0}}};
      Simulation simulation(scene);
      const auto before = simulation.positions();
      advance(simulation, kSeconds);
      const double left = std::exp(-kDamping * kSeconds), way = (1 - left) / kDamping;
      const auto after = simulation.positions();
      const double ways[][2] = {{after[0] - before[0], speed * kSeconds + (3 - speed) * way},
                                {after[2] - before[2], -4 * way},
                                {after[1] - before[1], 0.01 * kSeconds},
                                {after[kOther] - before[kOther], 3 * kSeconds},
                                {after[kOther + 2] - before[kOther + 2], -4 * kSeconds}};
      double most = 0;
      for (const auto& [is, truth] : ways) most = std::max(most, std::abs(is - truth));
      expect(
          {"sliding damped in a layer",
           name_of(method) + std::string(speed > 0 ? ", moving plane" : "") + ", worst of 5 ways",
           0, 1e-3, "m"},
          most);
    }
}

// On a slope without friction a particle ends as fast as damping takes what gravity gives, g sin α / c, less
// what gravity gives in the one substep that is damped with the rest.
TEST(ValidationContact, TheLayerGivesASlopeATerminalSpeed) {
  for (const Method method : {Method::spring, Method::compliant}) {
    Scene scene = incline(20, 0, 0, method);
    scene.colliders[0].friction.damping = 20;
    scene.colliders[0].friction.bias = 1e-3;
    Simulation simulation(scene);
    advance(simulation, 1);
    const double before = at(simulation.positions(), 0)[0], since = simulation.time();
    advance(simulation, 2);
    expect(
        {"sliding damped in a layer", name_of(method) + std::string(": terminal speed on a slope"),
         9.81 * std::sin(20 * M_PI / 180) * (1.0 / 20 - scene.time.frame / 20), 1e-3, "m/s"},
        (at(simulation.positions(), 0)[0] - before) / (simulation.time() - since));
  }
}

}  // namespace
}  // namespace weft
