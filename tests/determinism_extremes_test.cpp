// Scenes that are allowed and extreme: they run to their end, and have one result on every machine.
#include <gtest/gtest.h>

#include <algorithm>

#include "machines.h"
#include "sheets.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

Scene scene_of(const std::string& text) {
  return read_scene_text(text).scene;
}

void expect_one_result(const std::string& text, int frames) {
  const Scene scene = scene_of(text);
  std::uint64_t expected = 0;
  bool first = true;
  for (const Options& options : machines()) {
    Simulation simulation(scene, options);
    for (int n = 0; n < frames; ++n) simulation.advance_frame();
    EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
    if (first) expected = simulation.hash();
    first = false;
    EXPECT_EQ(simulation.hash(), expected)
        << simd_name(simulation.simd()) << ", " << simulation.threads() << " threads";
  }
}

TEST(Extremes, ParticlesThatPinsDrawFarAtOnceMeet) {
  expect_one_result(R"({"weft": 1, "cloths": [{"grid": {"points": [7, 2]}, "density": 0.02,
      "stiffness": {"structural": 65005}, "self_collision": {"mode": "particles"},
      "pins": [{"at": [2, 0], "keys": [[0, 0, 0, -1]]}]}]})",
                    20);
}

TEST(Extremes, SurfacesWithoutAnyNearSquares) {
  expect_one_result(R"({"weft": 1, "cloths": [{"grid": {"points": [20, 14], "u": [0, -0.1, 0],
      "v": [-0.2, 0, 1]}, "self_collision": {"mode": "surface"},
      "pins": [{"at": [18, 13], "keys": [[0, 0, 0, 0]]}]}]})",
                    20);
}

TEST(Extremes, TrianglesOfACoarseMeshOverASmallBall) {
  expect_one_result(R"({"weft": 1, "cloths": [{"grid": {"points": [6, 6]}}],
      "colliders": [{"sphere": {"center": [0.5, -0.1, 0.5], "radius": 0.2}}]})",
                    20);
}

// A plane of symmetry at zero: signs of zero come from the least differences in the order of work.
TEST(Extremes, StrainLimitsOfSheetsThroughZero) {
  for (const char* keys :
       {"[[0, 0, 0, 0], [1, 0, 0.5, 0]]", "[[0, 0, 0, 0]]", "[[0, 0, 0.3, -0.0]]"})
    expect_one_result(R"({"weft": 1, "cloths": [{"grid": {"points": [11, 2]}, "strain_limit": 0.03,
        "pins": [{"at": [0, 0], "keys": )" +
                          std::string(keys) + "}]}]}",
                      30);
}

// Constraints at their limit but for rounding, beside others that are far beyond it: which of them share
// a block hangs on the width of the kernels.
TEST(Extremes, StrainLimitsToTheLastBit) {
  expect_one_result(R"({"weft": 1, "solver": {"method": "spring_friction"}, "cloths": [{"grid": {
      "points": [3, 32], "origin": [0, -0.0548308908434885, 0.02245375576726037],
      "u": [0.0014177793754346572, 0, 0], "v": [0, 0, 0.09358362304203564]},
      "density": 1.5805113752541025, "stiffness": {"structural": 312.36144780921325,
      "shear": 1.7405639790830985, "bend": 0}, "spring_damping": {"shear": 0.21231449811628672},
      "stiffness_gradient": 0.5866986479491524, "drag": 0.03,
      "strain_limit": 0.00018793441161280746, "tear_strain": 1, "pins": [
      {"at": [0, 0], "keys": [[0, 0, 0, 0]]}, {"at": [2, 2], "keys": [[0, 0.08697658258894193,
      -0.0548308908434885, 0.08283028676212208]]}]}]})",
                    2);
}

TEST(Extremes, CollidersThatPassAtAnySpeed) {
  for (const char* shape : {R"("sphere": {"center": [0, 0, 0], "radius": 0.01})",
                            R"("box": {"center": [0, 0, 0], "half": [0.01, 0.01, 0.01]})",
                            R"("capsule": {"a": [0, 0, 0], "b": [0.1, 0, 0], "radius": 0.01})"})
    expect_one_result(R"({"weft": 1, "time": {"frame": 0.01, "substeps": 1}, "cloths": [{"grid":
        {"points": [6, 6]}}], "colliders": [{)" +
                          std::string(shape) +
                          R"(, "keys": [[0, 0.5, -9999, 0.5], [0.05, 0.5, 9999, 0.5]]}]})",
                      10);
}

// A pin with keys is where they say from the start, and a note tells when that is far from the sheet.
TEST(Extremes, PinsBeginWhereTheirKeysSay) {
  const std::string begin = R"({"weft": 1, "cloths": [{"grid": {"points": [5, 5]}, "pins": [{"at":
      [2, 0], "keys": [)";
  const Simulation far(scene_of(begin + "[0.5, 0.5, 0.75, 0], [1, 0.5, 0, 0]]}]}]}"));
  EXPECT_EQ(position(far, 2, 0), (Vec3{0.5, 0.75, 0}));
  const auto told = [](const Simulation& s) {
    return std::count_if(s.plan().notes.begin(), s.plan().notes.end(), [](const std::string& note) {
      return note.find("1 pin starts 0.75 m from") != std::string::npos;
    });
  };
  EXPECT_EQ(told(far), 1);
  const Simulation near(scene_of(begin + "[0.5, 0.5, 0.1, 0], [1, 0.5, 0, 0]]}]}]}"));
  EXPECT_EQ(position(near, 2, 0)[1], double(0.1f));
  EXPECT_EQ(told(near), 0);
}

}  // namespace
}  // namespace weft
