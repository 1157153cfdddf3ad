// Broken mesh files: each is refused with a line and a reason, or makes cloth that runs.
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>

#include "made_up_mesh.h"
#include "weft/mesh.h"
#include "weft/simulation.h"

namespace weft {
namespace {

std::string disc() {
  std::ostringstream text;
  text << std::ifstream(WEFT_SOURCE_DIR "/scenes/flag_round.obj").rdbuf();
  return text.str();
}

const std::vector<std::string>& originals() {
  static const std::vector<std::string> all = {
      disc(),
      "o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\ng left\nf 1 2 3 4\n"
      "g right\nf 2 5 6 3\nl 1 3\n",
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 3/3 2/2\nf 1/1 2/2 4/3\n"
      "f 2/1 3/2 4/3\nf 1/1 4/2 3/3\n",
      "v -1 0 0\nv 0 -1 0\nv 1 0 0\nv 0 1 0\nv 0 0 2\nf -5 -4 -3 -2\nf 1 2 5\n",
  };
  return all;
}

// Words are changed, dropped, doubled and put elsewhere, and bytes broken.
std::string broken(std::string text, std::mt19937& random) {
  const std::vector<std::string> words = {"0",     "-1",    "1e9",   "nan",       "1e400", "3",
                                          "4/4/4", "//",    "-7/-7", "1e-9",      "f",     "v",
                                          "\n",    "l 1 2", "2",     "9999999999"};
  for (auto k = 1 + random() % 3; k > 0 && !text.empty(); --k) {
    const std::size_t at = random() % text.size();
    const std::size_t word = std::min(text.find_first_of(" \n", at), text.size());
    switch (random() % 5) {
      case 0:
        text[at] = char(random() % 256);
        break;
      case 1:
        text.erase(at, 1 + random() % 20);
        break;
      case 2:
        text.insert(at, text.substr(random() % text.size(), random() % 30));
        break;
      case 3:
        text.insert(word, " " + words[random() % words.size()]);
        break;
      default:
        text.replace(at, word - at, words[random() % words.size()]);
        break;
    }
  }
  return text;
}

void expect_cloth(const MeshFile& file, const std::string& text) {
  Scene scene;
  scene.cloths.emplace_back().mesh.shape = std::make_shared<TriangleMesh>(file.mesh);
  scene.cloths[0].bending = 1e-5;
  scene.time.frame = 1e-4;
  for (const Fault& fault : validate(scene)) EXPECT_EQ(fault.place, "/cloths/0/mesh/scale") << text;
  if (!validate(scene).empty()) return;
  try {
    Simulation run(scene, {.threads = 1});
    run.advance_frame();
    for (const double value : run.positions()) ASSERT_TRUE(std::isfinite(value)) << text;
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("substeps"), std::string::npos) << text;
  }
}

TEST(MeshFuzz, BrokenFilesAreRefusedOrMakeCloth) {
  std::mt19937 random(1);
  int refused = 0, read = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::string text = broken(originals()[random() % originals().size()], random);
    const MeshFile file = read_obj(text, "m.obj");
    for (const Fault& fault : file.faults) {
      EXPECT_EQ(fault.place.rfind("m.obj", 0), 0u) << text;
      EXPECT_FALSE(fault.what.empty() || fault.allowed.empty()) << text;
    }
    (file.faults.empty() ? read : refused) += 1;
    if (file.faults.empty()) expect_cloth(file, text);
  }
  EXPECT_GT(refused, 300);
  EXPECT_GT(read, 200);
}

// Whatever is asked of the methods that project together: no fault, nothing that is no number, and no more
// energy than falling gives.
TEST(MeshFuzz, SweepsHoldWhateverIsAsked) {
  std::mt19937 random(3);
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, double(random()) / 4294967296.0);
  };
  for (int round = 0; round < 60; ++round) {
    Scene scene;
    Cloth& cloth = scene.cloths.emplace_back();
    const int nx = 2 + int(random() % 30), ny = 2 + int(random() % 30);
    const auto mesh = made_up({.nx = nx,
                               .ny = ny,
                               .width = between(0.05, 5),
                               .height = between(0.05, 5),
                               .shift = 0.1 * double(random() % 5),
                               .shuffled = random() % 2 == 0,
                               .seed = unsigned(random())});
    cloth.mesh.shape = mesh;
    cloth.stiffness.structural = between(1, 1e7);
    cloth.density = between(0.01, 10);
    cloth.drag = random() % 2 == 0 ? 0 : between(0.1, 10);
    if (random() % 2 == 0) cloth.bending = between(1e-7, 1);
    if (random() % 3 == 0) cloth.strain_limit = between(1e-3, 0.5);
    cloth.velocity = {between(0.01, 20), 0, -between(0.01, 20)};
    for (auto n = random() % 5; n > 0; --n) cloth.pins.push_back({int(n), 0, {}});
    Solver& solver = scene.solver;
    solver.method = Method::compliant;
    solver.sweep = random() % 2 == 0 ? Sweep::line : Sweep::gauss_seidel;
    solver.order = 1 + int(random() % 2);
    solver.iterations = 1 + int(random() % 4);
    solver.tethers = random() % 2 == 0;
    scene.time.substeps = random() % 3 == 0 ? kAutoSubsteps : 1 + int(random() % 40);
    if (random() % 3 == 0)
      scene.colliders.push_back({Sphere{{0.3, -0.2, 0.2}, 0.15}, {}, 0.001, {}, false});
    if (random() % 3 == 0) scene.wind = {{3, 1, 0}, 0.5, 0.1, 0.3};
    ASSERT_TRUE(validate(scene).empty()) << round << ": " << validate(scene)[0].what;
    std::uint64_t hash = 0;
    for (const int threads : {1, 2}) {
      Simulation run(scene, {.threads = threads});
      const double start = run.report().energy.total;
      for (int n = 0; n < 20; ++n) run.advance_frame();
      ASSERT_TRUE(run.status().ok) << round << ": " << run.status().text;
      if (threads == 1) hash = run.hash();
      EXPECT_EQ(run.hash(), hash) << round;
      const double speed = 30 + 9.81 / 3;  // and of the wind
      const double mass = cloth.density * 25;
      EXPECT_LT(run.report().energy.kinetic, std::abs(start) + mass * speed * speed) << round;
    }
  }
}

TEST(MeshFuzz, MeshesOfProgramsAreLookedAt) {
  const MeshFile file = read_obj(originals()[1], "m.obj");
  const auto told = [&](void (*change)(TriangleMesh&)) {
    Scene scene;
    auto mesh = std::make_shared<TriangleMesh>(file.mesh);
    change(*mesh);
    scene.cloths.emplace_back().mesh.shape = mesh;
    std::string text;
    for (const Fault& fault : validate(scene)) text += fault.place;
    return text;
  };
  EXPECT_EQ(told([](TriangleMesh&) {}), "");
  EXPECT_EQ(told([](TriangleMesh& m) { m.triangles.clear(); }), "/cloths/0/mesh");
  EXPECT_EQ(told([](TriangleMesh& m) { m.triangles[1][2] = 6; }), "/cloths/0/mesh");
  EXPECT_EQ(told([](TriangleMesh& m) { m.triangles[1][2] = -1; }), "/cloths/0/mesh");
  EXPECT_EQ(told([](TriangleMesh& m) { m.uv.resize(1); }), "/cloths/0/mesh");
  EXPECT_EQ(told([](TriangleMesh& m) { m.vertices[0][1] = std::nan(""); }), "/cloths/0/mesh/scale");
  EXPECT_EQ(told([](TriangleMesh& m) { m.vertices[0] = m.vertices[1]; }), "/cloths/0/mesh/scale");
}

}  // namespace
}  // namespace weft
