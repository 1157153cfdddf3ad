// What a report tells of a run: shares of the elastic energy in closed form, the strain of all frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

constexpr double kWarp = 3000, kBending = 1e-3, kSide = 1;

Scene sheet(const std::string& material) {
  const std::string text =
      R"({"weft": 1, "gravity": [0, 0, 0], "cloths": [{"grid": {"points": [17, 17],
      "u": [1, 0, 0], "v": [0, 0, 1]}, "pins": [[0, 0]], )" +
      material + "}]}";
  const SceneFile file = read_scene_text(text);
  EXPECT_TRUE(file.faults.empty()) << file.faults[0].what;
  return file.scene;
}

// Moves all particles by a map of their places.
Report mapped(const Scene& scene, Vec3 (*map)(const Vec3&)) {
  Simulation simulation(scene);
  std::vector<double> x = simulation.positions();
  for (std::size_t n = 0; n < x.size(); n += 3) {
    const Vec3 to = map({x[n], x[n + 1], x[n + 2]});
    std::copy(to.begin(), to.end(), x.begin() + std::ptrdiff_t(n));
  }
  simulation.set_state(x, std::vector<double>(x.size()));
  return simulation.report(false);
}

Vec3 stretched(const Vec3& p) {
  return {1.1 * p[0], p[1], p[2]};
}
// An arc of radius 2 m about the z axis.
Vec3 rolled(const Vec3& p) {
  return {2 * std::sin(p[0] / 2), 2 - 2 * std::cos(p[0] / 2), p[2]};
}

TEST(ReportEnergy, OfAStretchedMembraneIsAllItsOwn) {
  const Report r =
      mapped(sheet(R"("membrane": {"warp": 3000, "weft": 2000, "shear": 100}, "bending": 0.001)"),
             stretched);
  const double strain = 0.5 * (1.1 * 1.1 - 1);  // Green's
  EXPECT_NEAR(r.membrane_energy, 0.5 * kWarp * strain * strain * kSide * kSide, 1e-4);
  EXPECT_NEAR(r.bending_energy, 0, 1e-6);
  EXPECT_DOUBLE_EQ(r.energy.elastic, r.membrane_energy + r.bending_energy);
}

TEST(ReportEnergy, OfSpringsIsNeither) {
  const Report r = mapped(sheet(R"("stiffness": {"structural": 3000})"), stretched);
  EXPECT_GT(r.energy.elastic, 1);
  EXPECT_EQ(r.membrane_energy, 0);
  EXPECT_EQ(r.bending_energy, 0);
}

TEST(ReportEnergy, OfARolledSheetIsOfBending) {
  for (const char* material :
       {R"("membrane": {"warp": 3000, "weft": 2000, "shear": 100}, "bending": 0.001)",
        R"("stiffness": {"structural": 3000}, "bending": 0.001)"}) {
    const Report r = mapped(sheet(material), rolled);
    // Curvature 1/2 at all columns but the outermost, which have a neighbour on one side alone.
    const double whole = 0.5 * kBending * 0.25 * kSide * kSide;
    EXPECT_LT(r.bending_energy, whole) << material;
    EXPECT_GT(r.bending_energy, 0.9 * whole) << material;
  }
}

TEST(ReportStrain, OfFramesIsTheGreatestOfAll) {
  for (const Method method : {Method::spring, Method::positional, Method::compliant}) {
    Scene scene = sheet(R"("stiffness": {"structural": 300})");
    scene.gravity = {0, 0, 9.81};
    scene.solver.method = method;
    Simulation followed(scene, {.threads = 1, .follow_strain = true}), plain(scene, {.threads = 1});
    EXPECT_EQ(followed.report(false).strain.max_of_frames, followed.report(false).strain.max);
    double most = -1;
    for (int n = 0; n < 40; ++n) {
      followed.advance_frame();
      plain.advance_frame();
      most = std::max(most, plain.report(false).strain.max);
    }
    EXPECT_EQ(followed.report(false).strain.max_of_frames, most);
    EXPECT_FALSE(plain.report(false).strain.max_of_frames.has_value());
    EXPECT_EQ(followed.hash(), plain.hash());
    EXPECT_EQ(plain.report(false).notes, plain.plan().notes);
  }
}

}  // namespace
}  // namespace weft
