// What a feature adds to a step: the plain sheet of springs with one thing switched on at a time.
#include <functional>

#include "../tests/made_up_bodies.h"
#include "throughput.h"

namespace bench {
namespace {

struct Feature {
  const char* name;
  const char* stage;  // a stage the plan must then contain; "" = none of its own
  std::function<void(weft::Scene&)> switch_on;
};

weft::Collider sphere_at(double y) {
  weft::Collider c;
  c.shape = weft::Sphere{{0.5, y, 0.5}, 0.3};
  c.friction = {weft::FrictionModel::coulomb, 0.3, 0.3};
  return c;
}

// Lies under the sheet, or far from it.
weft::Collider ball_of(int around, double y) {
  weft::Collider c = weft::tests::body_of(weft::tests::ball(around, around / 2, 0.3), 0.3);
  std::get<weft::MeshBody>(c.shape).translate = {0.5, y, 0.5};
  return c;
}

// In place of the springs, and about as stiff.
void use_membrane(weft::Scene& scene, double damping) {
  weft::Cloth& cloth = scene.cloths[0];
  const double k = cloth.stiffness.structural, s = cloth.stiffness.shear;
  cloth.stiffness = weft::Cloth().stiffness;
  cloth.membrane = {k + s, k + s, s, s, damping};
}

std::vector<Feature> features() {
  return {
      {"plain", "", [](weft::Scene&) {}},
      {"drag", "", [](weft::Scene& s) { s.cloths[0].drag = 1; }},
      {"gradient", "", [](weft::Scene& s) { s.cloths[0].stiffness_gradient = 0.4; }},
      {"spring damping", "",
       [](weft::Scene& s) {
         s.solver.method = weft::Method::spring_friction;
         s.cloths[0].spring_damping = {0.001, 0.001, 0.001};
       }},
      {"strain limit", "strain_limit", [](weft::Scene& s) { s.cloths[0].strain_limit = 0.1; }},
      {"sphere, far", "", [](weft::Scene& s) { s.colliders.push_back(sphere_at(-9)); }},
      {"sphere, near", "", [](weft::Scene& s) { s.colliders.push_back(sphere_at(-0.295)); }},
      {"body of 1e3 triangles, far", "",
       [](weft::Scene& s) { s.colliders.push_back(ball_of(32, -9)); }},
      {"body of 1e3 triangles, near", "",
       [](weft::Scene& s) { s.colliders.push_back(ball_of(32, -0.295)); }},
      {"body of 1e4 triangles, near", "",
       [](weft::Scene& s) { s.colliders.push_back(ball_of(100, -0.295)); }},
      {"body of 1e5 triangles, far", "",
       [](weft::Scene& s) { s.colliders.push_back(ball_of(316, -9)); }},
      {"body of 1e5 triangles, near", "",
       [](weft::Scene& s) { s.colliders.push_back(ball_of(316, -0.295)); }},
      {"plane, far", "",
       [](weft::Scene& s) {
         s.colliders.emplace_back();
         s.colliders[0].shape = weft::Plane{{0, -9, 0}, {0, 1, 0}};
       }},
      {"self-collision, flat", "self_collision",
       [](weft::Scene& s) {
         s.cloths[0].self_collision.mode = weft::SelfCollisionMode::particles;
         s.cloths[0].self_collision.thickness = 0.01;
       }},
      {"tearing, whole", "tear", [](weft::Scene& s) { s.cloths[0].tear_strain = 5; }},
      {"tearing, shreds", "tear", [](weft::Scene& s) { s.cloths[0].tear_strain = 5; }},
      {"bending", "bending", [](weft::Scene& s) { s.cloths[0].bending = 1e-5; }},
      {"membrane", "membrane", [](weft::Scene& s) { use_membrane(s, 0); }},
      {"membrane, damped", "membrane", [](weft::Scene& s) { use_membrane(s, 1e-6); }},
      {"membrane, bending", "membrane",
       [](weft::Scene& s) {
         use_membrane(s, 0);
         s.cloths[0].bending = 1e-5;
       }},
      {"wind", "wind",
       [](weft::Scene& s) {
         s.wind.velocity = {1, 0, 0};
         s.wind.drag = 0.5;
       }},
      {"asleep", "",
       [](weft::Scene& s) {
         s.gravity = {0, 0, 0};
         s.cloths[0].drag = 100;  // rounding makes light springs shiver
         s.solver.sleep = 0.1;
       }},
  };
}

// Cuts across the sheet, which lies in the xz-plane, every seven squares both ways.
void cut_to_shreds(weft::Simulation& simulation) {
  const int n = simulation.view().cloths[0].columns;
  for (int k = 3; k < n - 1; k += 7) {
    const double at = (k + 0.5) / (n - 1);
    simulation.cut({-1, 0, at}, {2, 0, at}, 0.1 / n);
    simulation.cut({at, 0, -1}, {at, 0, 2}, 0.1 / n);
  }
}

void run_feature(benchmark::State& state, const Feature& feature, int n) {
  weft::Scene scene = stepping_scene(n, 16);
  feature.switch_on(scene);
  weft::Options options;
  options.threads = 1;
  weft::Simulation simulation(scene, options);
  bool found = *feature.stage == 0;
  for (const auto& s : simulation.plan().stages)
    found |= (s.name + " " + s.detail).find(feature.stage) != std::string::npos;
  if (!found) {
    state.SkipWithError("not in the plan");
    return;
  }
  if (std::string(feature.name).find("shreds") != std::string::npos) cut_to_shreds(simulation);
  do simulation.advance_frame();
  while (scene.solver.sleep > 0 && simulation.time() < 0.6);  // asleep after half a second
  const double ns = fastest_ns(state, [&] { simulation.advance_frame(); });
  if (!simulation.status().ok) state.SkipWithError(simulation.status().text.c_str());
  count_work(state, widest(), ns, {16, double(n) * n, 0});
}

}  // namespace

void register_features(bool quick) {
  for (const Feature& f : features())
    for (int n : quick ? std::vector<int>{100} : std::vector<int>{100, 316}) {
      const std::string name = "feature/" + std::string(f.name) + "/" + std::to_string(n);
      add_benchmark(name, [f, n](benchmark::State& s) { run_feature(s, f, n); });
    }
}

}  // namespace bench
