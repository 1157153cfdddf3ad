// The drape test of Cusick with every fabric of weft/fabric.h, on coarse meshes that take a second each. bench/cusick is
// the same on finer ones, of several specimens.
#include <gtest/gtest.h>

#include "cusick.h"
#include "truth.h"
#include "weft/fabric.h"

namespace weft {
namespace {

constexpr int kCoarse = 14;

const char* const kLaw = "Drape test of Cusick";

// Of measured fabrics, and their middle is the truth.
struct Band {
  const char* fabric;
  double least, most;  // %
};
constexpr Band kBands[] = {
    {"silk", 20, 40}, {"cotton", 60, 76}, {"wool", 40, 70}, {"denim", 70, 90}, {"leather", 47, 70}};

// The coefficient of a shape whose shadow is known.
TEST(Drape, TheShadowIsTheAreaOfTheUnion) {
  const auto mesh = cusick::disc({.rings = 20, .waves = 0});
  std::vector<double> places;
  const auto shadow_of = [&](double scale, double lift) {
    places.clear();
    for (const Vec3& v : mesh->vertices)
      places.insert(places.end(), {scale * v[0], lift * v[0], scale * v[1]});
    return cusick::shadow(mesh->triangles, places);
  };
  const double corners = 6 * 20, pi = std::numbers::pi;
  const auto ring = [&](double radius) {  // between a polygon and the round support
    return corners / 2 * std::sin(2 * pi / corners) * radius * radius -
           pi * cusick::kSupport * cusick::kSupport;
  };
  EXPECT_NEAR(shadow_of(cusick::kDisc, 0), ring(cusick::kDisc), 1e-4 * ring(cusick::kDisc));
  EXPECT_NEAR(shadow_of(0.12, 3), ring(0.12), 1e-4 * ring(0.12));  // whatever the heights
  EXPECT_NEAR(shadow_of(0.05, 0), 0, 1e-7);                        // within the support
  // What lies twice in one place counts once, whichever way it looks.
  auto twice = mesh->triangles;
  for (const auto& t : mesh->triangles) twice.push_back({t[1], t[0], t[2]});
  shadow_of(cusick::kDisc, 0);
  EXPECT_NEAR(cusick::shadow(twice, places), ring(cusick::kDisc), 1e-4 * ring(cusick::kDisc));
}

TEST(Drape, TheShippedMeshIsTheSame) {
  const Scene scene = read_scene("cusick").scene;
  const TriangleMesh& shipped = *scene.cloths[0].mesh.shape;
  const auto made = cusick::disc({});
  ASSERT_EQ(shipped.vertices.size(), made->vertices.size());
  EXPECT_EQ(shipped.triangles, made->triangles);
  for (std::size_t n = 0; n < made->vertices.size(); ++n)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_NEAR(shipped.vertices[n][k], made->vertices[n][k], 1e-6);
  ASSERT_FALSE(scene.cloths[0].pins.empty());
  EXPECT_EQ(held_particles(scene.cloths[0], scene.cloths[0].pins[0]), made->groups[0].vertices);
}

cusick::Drape rested(const std::string& fabric, const cusick::Disc& disc,
                     const std::vector<Override>& overrides = {}) {
  const cusick::Drape d = cusick::drape(cusick::scene_of(fabric, disc, overrides));
  EXPECT_LT(d.speed, 2e-3) << fabric << " is at rest";
  return d;
}

TEST(Drape, EveryFabricIsWithinItsBand) {
  ASSERT_EQ(std::size(kBands), fabrics().size());
  for (const Band& band : kBands) {
    const cusick::Drape d = rested(band.fabric, {.rings = kCoarse});
    const double middle = (band.least + band.most) / 2;
    expect({kLaw, std::string(band.fabric) + ", coefficient, middle of its band", middle,
            band.most / middle - 1, "%"},
           d.coefficient);
    EXPECT_GE(d.folds, 3) << band.fabric;
    EXPECT_LE(d.folds, 12) << band.fabric;
  }
}

// Edges of 11 and 5 mm; and the whole turned in space, with another of six directions of the mesh that are alike along
// the warp.
TEST(Drape, OfDenimIsThatOfFinerAndOfTurnedMeshes) {
  const double coarse = rested("denim", {.rings = kCoarse}).coefficient;
  const double fine = rested("denim", {.rings = 2 * kCoarse}).coefficient;
  expect({kLaw, "denim, change when edges halve", 0, 2, "points"}, fine - coarse);
  const double turned =
      rested("denim", {.rings = kCoarse, .turn = 60}, {{"/cloths/0/mesh/rotate", "[-90, 37, 0]"}})
          .coefficient;
  expect({kLaw, "denim, change when warp and mesh turn", 0, 0.1, "points"}, turned - coarse);
}

}  // namespace
}  // namespace weft
