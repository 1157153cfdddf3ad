// What must not change a motion: the unit of length, where frames end, which way is left, which way
// rows run. Binary fractions and powers of two leave no room for rounding, so that these are the same
// bits; turned sheets are summed up in another order.
#include <algorithm>
#include <cmath>

#include "sheet_features.h"

namespace weft {
namespace {

using Places = std::vector<double>;

// Everything that is a point or a direction.
template <class Change>
void change_vectors(Scene& scene, const Change& change) {
  const auto keys = [&](std::vector<Key>& all) {
    for (Key& key : all) change(key.position);
  };
  change(scene.gravity);
  change(scene.wind.velocity);
  for (Cloth& cloth : scene.cloths) {
    for (Vec3* v : {&cloth.grid.origin, &cloth.grid.u, &cloth.grid.v}) change(*v);
    for (Pin& pin : cloth.pins) keys(pin.keys);
  }
  for (Collider& c : scene.colliders) {
    keys(c.keys);
    if (auto* sphere = std::get_if<Sphere>(&c.shape)) change(sphere->center);
    if (auto* plane = std::get_if<Plane>(&c.shape)) change(plane->point), change(plane->normal);
    if (auto* capsule = std::get_if<Capsule>(&c.shape)) change(capsule->a), change(capsule->b);
  }
}

// The same scene in a unit of length `scale` times as small: masses, times and stiffnesses stay.
Scene scaled(Scene scene, double scale) {
  change_vectors(scene, [&](Vec3& v) {
    for (double& x : v) x *= scale;
  });
  scene.wind.drag /= scale * scale * scale;
  scene.wind.lift /= scale * scale * scale;
  for (Cloth& cloth : scene.cloths) {
    cloth.density /= scale * scale;
    cloth.bending = cloth.bending.warp * scale * scale;
    cloth.self_collision.thickness *= scale;
  }
  for (Collider& c : scene.colliders) {
    if (auto* sphere = std::get_if<Sphere>(&c.shape)) sphere->radius *= scale;
    if (auto* capsule = std::get_if<Capsule>(&c.shape)) capsule->radius *= scale;
  }
  return scene;
}

struct Way {
  const char* name;
  Method method;
  Sweep sweep = Sweep::gauss_seidel;
  int order = 1;
};

// Every feature by every method: `compare` gets the scene and where its particles are in the end.
template <class Compare>
void each(const Compare& compare) {
  for (const Feature& feature : features())
    for (const Way& way : {Way{"spring", Method::spring},
                           {"compliant", Method::compliant},
                           {"positional", Method::positional},
                           {"line", Method::compliant, Sweep::line},
                           {"line, order 2", Method::compliant, Sweep::line, 2}}) {
      SCOPED_TRACE(feature.name + ", " + way.name);
      Scene scene = hanging_sheet();
      feature.set(scene);
      scene.solver.method = way.method;
      scene.solver.sweep = way.sweep;
      scene.solver.order = way.order;
      compare(feature, scene, half_a_second(scene, feature));
    }
}

TEST(Invariance, TheUnitOfLengthIsFree) {
  each([](const Feature& feature, const Scene& beside, const Places&) {
    if (feature.name == "pull") return;  // to a target that is not in the scene
    // What surfaces divide by is kept off zero by lengths.
    const double least = feature.name == "two sheets, surface" ? 1e-3 : 0;
    // About zero, so that it is the origin in any unit.
    const Scene scene = moved(beside, {-0.25, 0, -0.25});
    const Places places = half_a_second(scene, feature);
    for (const double scale : {0.125, 8.0}) {
      Feature same = feature;
      if (feature.name == "carried pins")
        same.begin = [=](Simulation& s) { s.carry(0, {0.5 * scale, 0.25 * scale, 0}); };
      Places other = half_a_second(scaled(scene, scale), same);
      for (double& x : other) x /= scale;
      EXPECT_LE(apart(other, places), least) << scale;
    }
  });
}

TEST(Invariance, FramesEndAnywhere) {
  each([](const Feature& feature, Scene scene, const Places& places) {
    // Pushes of the air, and what tears, are gathered within a frame.
    const double least = feature.name == "wind"               ? 5e-3
                         : feature.name == "tearing"          ? 1e-2
                         : feature.name == "tearing, by area" ? 1.5e-2
                                                              : 1e-15;
    for (const int parts : {2, 8}) {
      scene.time.frame = 1.0 / 60 / parts;
      scene.time.substeps = 64 / parts;
      EXPECT_LE(apart(half_a_second(scene, feature), places), least) << parts;
    }
  });
}

TEST(Invariance, LeftIsNotRight) {
  each([](const Feature& feature, Scene scene, const Places& places) {
    if (feature.name == "pull" || feature.name == "carried pins") return;
    change_vectors(scene, [](Vec3& v) { v[0] = -v[0]; });
    Places other = half_a_second(scene, feature);
    for (std::size_t k = 0; k < other.size(); k += 3) other[k] = -other[k];
    // Pairs are met in the order of their cells.
    const bool meet = scene.cloths[0].self_collision.mode != SelfCollisionMode::off;
    EXPECT_LE(apart(other, places), meet ? 2e-3 : 0);
  });
}

// Rigid constraints crumple a sheet, and what crumples makes much of rounding.
bool rigid(const Scene& scene) {
  return scene.solver.method == Method::positional;
}

// Axes in another order.
TEST(Invariance, NoAxisIsSpecial) {
  each([](const Feature& feature, Scene scene, const Places& places) {
    if (feature.name == "pull" || feature.name == "carried pins") return;
    change_vectors(scene, [](Vec3& v) { std::rotate(v.begin(), v.begin() + 1, v.end()); });
    Places other = half_a_second(scene, feature);
    for (std::size_t k = 0; k < other.size(); k += 3)
      std::rotate(other.begin() + k, other.begin() + k + 2, other.begin() + k + 3);
    const bool meet = scene.cloths[0].self_collision.mode != SelfCollisionMode::off;
    const double least = meet || !scene.colliders.empty() ? 2e-3 : 2e-4;
    EXPECT_LE(apart(other, places), rigid(scene) ? 1e-2 : least);
  });
}

// Columns in the place of rows: sweeps see constraints in another order.
TEST(Invariance, RowsAreNotColumns) {
  each([](const Feature& feature, Scene scene, const Places& places) {
    if (rigid(scene) || feature.name == "pull" || feature.name == "stiffness gradient") return;
    for (Cloth& cloth : scene.cloths) {
      std::swap(cloth.grid.u, cloth.grid.v);
      for (Pin& pin : cloth.pins) std::swap(pin.i, pin.j);
      const auto masses = cloth.masses;
      for (std::size_t p = 0; p < masses.size(); ++p)
        cloth.masses[p] = masses[p % kFeatureSide * kFeatureSide + p / kFeatureSide];
    }
    const Places other = half_a_second(scene, feature);
    Places turned;
    for (std::size_t p = 0; p < other.size() / 3; ++p) {
      const std::size_t cloth = p / (kFeatureSide * kFeatureSide),
                        in = p % (kFeatureSide * kFeatureSide);
      const std::size_t q = cloth * kFeatureSide * kFeatureSide + in % kFeatureSide * kFeatureSide +
                            in / kFeatureSide;
      turned.insert(turned.end(), other.begin() + 3 * q, other.begin() + 3 * q + 3);
    }
    EXPECT_LE(apart(turned, places), 5e-3);
  });
}

}  // namespace
}  // namespace weft
