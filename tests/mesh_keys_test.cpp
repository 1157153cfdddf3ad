// What each key of the scene format does to a mesh: it changes the run, or is refused, or is told of in a
// note. A key that is new in the schema has to be named here.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "folder.h"
#include "made_up_balloon.h"
#include "made_up_mesh.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

using Json = nlohmann::json;

// Where a key stands in a scene, a value that is not its default, and what it goes with.
struct Key {
  const char* value;
  const char* beside = "{}";  // merged into the scene before
};

// Beside what one of a membrane's moduli is tried with.
const char* const kFabric = R"({"cloths": [{"mesh": {"file": "m.obj"}, "pins": [0, 30],
    "membrane": {"warp": 900, "weft": 800, "shear": 60}}]})";

// Another mesh comes down on it at a slant.
const char* const kMeets = R"({"cloths": [
    {"mesh": {"file": "m.obj"}, "pins": [0, 30],
     "self_collision": {"mode": "particles", "thickness": 0.1}},
    {"mesh": {"file": "other.obj", "translate": [0, 0.11, 0]}, "velocity": [1, -1, 0],
     "self_collision": {"mode": "particles", "thickness": 0.1}}]})";

// What bends, and what rests as its texture coordinates.
const char* const kCurved = R"({"cloths": [{"mesh": {"file": "curved.obj"}, "pins": [0, 30],
    "bending": 0.01}]})";
const char* const kPattern = R"({"cloths": [{"mesh": {"file": "mapped.obj", "rest": "uv"},
    "pins": [0, 30]}]})";

// What holds a gas, and a gas in it.
const char* const kClosed = R"({"cloths": [{"mesh": {"file": "closed.obj"}, "pins": [0]}]})";
const char* const kInflated = R"({"cloths": [{"mesh": {"file": "closed.obj"}, "pins": [0],
    "pressure": {"inflate": 1.2}}]})";

const std::map<std::string, Key> kKeys = {
    {"/gravity", {"[0, -5, 0]"}},
    {"/time/frame", {"0.01"}},
    {"/time/substeps", {"300"}},
    {"/solver/method", {R"("compliant")"}},
    {"/solver/sweep", {R"("line")", R"({"solver": {"method": "compliant"}})"}},
    {"/solver/tethers", {"true", R"({"solver": {"method": "compliant"}})"}},
    {"/solver/order", {"2", R"({"solver": {"method": "compliant"}})"}},
    {"/solver/iterations", {"3", R"({"solver": {"method": "compliant"}})"}},
    {"/solver/iterate_springs", {"true", R"({"solver": {"iterations": 2}})"}},
    {"/solver/full_first_kick", {"true"}},
    {"/solver/collision_iterations", {"3"}},
    {"/solver/sleep", {"0.5"}},
    {"/colliders", {R"([{"plane": {"point": [0, -0.01, 0]}}])"}},
    {"/wind/velocity", {"[3, 1, 0]", R"({"wind": {"drag": 0.5}})"}},
    {"/wind/drag", {"0.5", R"({"wind": {"velocity": [3, 1, 0]}})"}},
    {"/wind/lift", {"0.5", R"({"wind": {"velocity": [3, 1, 0]}})"}},
    {"/wind/turbulence", {"0.5", R"({"wind": {"velocity": [3, 1, 0], "drag": 0.5}})"}},
    {"/cloths/0/grid/points", {"[5, 5]"}},
    {"/cloths/0/grid/origin", {"[0, 1, 0]"}},
    {"/cloths/0/grid/u", {"[2, 0, 0]"}},
    {"/cloths/0/grid/v", {"[0, 0, 2]"}},
    {"/cloths/0/grid/jitter", {"0.01"}},
    {"/cloths/0/mesh/file", {R"("other.obj")"}},
    {"/cloths/0/mesh/scale", {"1.1"}},
    {"/cloths/0/mesh/rotate", {"[10, 0, 0]"}},
    {"/cloths/0/mesh/translate", {"[0, 1, 0]"}},
    {"/cloths/0/mesh/rest", {R"("flat")", kCurved}},
    {"/cloths/0/mesh/uv_scale", {"1.1", kPattern}},
    {"/cloths/0/fabric", {R"("silk")"}},
    {"/cloths/0/density", {"0.1"}},
    {"/cloths/0/particle_mass", {"0.01"}},
    {"/cloths/0/masses", {"[0.01, 0.01]"}},
    {"/cloths/0/stiffness/structural", {"500"}},
    {"/cloths/0/stiffness/shear", {"500"}},
    {"/cloths/0/stiffness/bend", {"500"}},
    {"/cloths/0/spring_damping/structural",
     {"0.1", R"({"solver": {"method": "spring_friction"}})"}},
    {"/cloths/0/spring_damping/shear", {"0.1"}},
    {"/cloths/0/spring_damping/bend", {"0.1"}},
    {"/cloths/0/lumping", {R"("equal")"}},
    {"/cloths/0/membrane/warp", {"500", kFabric}},
    {"/cloths/0/membrane/weft", {"500", kFabric}},
    {"/cloths/0/membrane/coupling", {"50", kFabric}},
    {"/cloths/0/membrane/shear", {"90", kFabric}},
    {"/cloths/0/membrane/damping", {"0.01", kFabric}},
    {"/cloths/0/level", {"2"}},
    {"/cloths/0/level_diagonals", {R"("one")"}},
    {"/cloths/0/stiffness_gradient", {"0.5"}},
    {"/cloths/0/positional_k", {"0.3"}},
    {"/cloths/0/velocity", {"[0, 1, 0]"}},
    {"/cloths/0/spin", {"[0, 1, 0]"}},
    {"/cloths/0/drag", {"1"}},
    {"/cloths/0/bending", {"0.01"}},
    {"/cloths/0/strain_limit", {"0.0001"}},
    {"/cloths/0/cuts", {"[[[0, 1], [3, 1]]]"}},
    {"/cloths/0/strain_limit_order", {R"("course")"}},
    {"/cloths/0/tear_strain", {"1e-6"}},
    {"/cloths/0/tears", {R"("particles")"}},
    {"/cloths/0/self_collision/mode", {R"("surface")", kMeets}},
    {"/cloths/0/self_collision/thickness", {"0.12", kMeets}},
    {"/cloths/0/self_collision/friction", {"0.1", kMeets}},
    {"/cloths/0/self_collision/response", {R"("course")"}},
    {"/cloths/0/pins", {"[1]"}},
    {"/cloths/0/sewing", {"true"}},
    {"/cloths/0/seams", {"[[3, 38]]"}},
    {"/cloths/0/pressure/over", {"100", kClosed}},
    {"/cloths/0/pressure/inflate", {"1.3", kClosed}},
    {"/cloths/0/pressure/ambient", {"1000", kInflated}},
    {"/cloths/0/pressure/keys", {"[[0, 1], [1, 2]]", kInflated}},
};
// Words for people, how long a run is, from where it is seen, and in which colours.
const std::set<std::string> kNotOfTheCloth = {"/weft",
                                              "/name",
                                              "/about",
                                              "/time/seconds",
                                              "/camera/azimuth",
                                              "/camera/elevation",
                                              "/camera/zoom",
                                              "/cloths/0/color/front",
                                              "/cloths/0/color/back"};

// The places of all keys below an object of the schema.
void collect(const Json& schema, const Json& object, const std::string& place,
             std::set<std::string>& places) {
  for (const auto& [key, value] : object.at("properties").items()) {
    const std::string here = place + "/" + key;
    if (key == "cloths")
      collect(schema, schema.at("/$defs/cloth"_json_pointer), here + "/0", places);
    else if (value.contains("properties"))
      collect(schema, value, here, places);
    else
      places.insert(here);
  }
}

std::set<std::string> places_of_the_schema() {
  std::ifstream file(std::string(WEFT_SOURCE_DIR) + "/docs/scene.schema.json");
  const Json schema = Json::parse(file);
  std::set<std::string> places;
  collect(schema, schema, "", places);
  return places;
}

void write_mesh(const std::string& path, const TriangleMesh& mesh) {
  std::ofstream file(path);
  file.precision(17);
  for (const Vec3& v : mesh.vertices) file << "v " << v[0] << " " << v[1] << " " << v[2] << "\n";
  for (const auto& t : mesh.triangles)
    file << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  file << "l 8 14\n";  // from side to side
}

struct Outcome {
  std::string refused;
  std::uint64_t hash = 0;
  std::vector<std::string> notes;
};

class MeshKeys : public testing::Test {
 protected:
  MeshKeys() {
    write_mesh(folder_ / "m.obj", *made_up({.nx = 7, .ny = 6, .shift = 0.2}));
    write_mesh(folder_ / "other.obj", *made_up({.nx = 6, .ny = 6, .shift = 0.2}));
    TriangleMesh mesh = *made_up({.nx = 7, .ny = 6, .shift = 0.2});
    for (const auto& t : mesh.triangles) {
      auto& uv = mesh.uv.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& at = mesh.vertices[std::size_t(t[k])];
        uv[k] = {at[0], at[2]};
      }
    }
    folder_.write("mapped.obj", write_obj(mesh));
    for (Vec3& at : mesh.vertices) at[1] = 0.3 * at[0] * at[0];
    write_mesh(folder_ / "curved.obj", mesh);
    folder_.write("closed.obj", write_obj(*made_up_balloon(1, 0.3)));
  }
  Outcome run(const Json& scene) {
    std::ofstream(folder_ / "s.json") << scene;
    const SceneFile file = read_scene(folder_ / "s.json");
    Outcome all;
    for (const Fault& f : file.faults) all.refused += f.place + " " + f.what + "\n";
    if (!file.faults.empty()) return all;
    Simulation simulation(file.scene, {.threads = 1});
    for (int n = 0; n < 4; ++n) simulation.advance_frame();
    EXPECT_TRUE(simulation.status().ok);
    all.hash = simulation.hash();
    all.notes = simulation.plan().notes;
    return all;
  }
  Folder folder_;
};

TEST_F(MeshKeys, AllAreNamed) {
  std::set<std::string> named = kNotOfTheCloth;
  for (const auto& [place, key] : kKeys) named.insert(place);
  EXPECT_EQ(places_of_the_schema(), named);
}

TEST_F(MeshKeys, NoneIsIgnored) {
  const Json base = Json::parse(R"({"weft": 1,
      "cloths": [{"mesh": {"file": "m.obj"}, "pins": [0, 30]}],
      "colliders": [{"sphere": {"center": [0.5, -0.11, 0.5], "radius": 0.1}, "friction": 0.3}]})");
  for (const auto& [place, key] : kKeys) {
    Json without = base;
    without.merge_patch(Json::parse(key.beside));
    Json with = without;
    with[Json::json_pointer(place)] = Json::parse(key.value);
    const Outcome a = run(without), b = run(with);
    if (!b.refused.empty()) {
      // At the key, its parent, or for the mesh as a whole.
      const std::string at = b.refused.substr(0, b.refused.find(' '));
      EXPECT_TRUE(place.rfind(at, 0) == 0 || at == "/cloths/0/mesh") << place << ": " << b.refused;
      continue;
    }
    EXPECT_TRUE(a.refused.empty()) << place << ": " << a.refused;
    EXPECT_TRUE(a.hash != b.hash || a.notes != b.notes) << place << " does nothing";
  }
}

// By method compliant, too.
TEST_F(MeshKeys, NoneOfAMembraneIsIgnoredBySweeps) {
  for (const char* sweep : {"gauss_seidel", "line"})
    for (const auto& [place, key] : kKeys) {
      if (!place.starts_with("/cloths/0/membrane")) continue;
      Json without = Json::parse(kFabric);
      without["weft"] = 1;
      without["solver"] = {{"method", "compliant"}, {"sweep", sweep}};
      Json with = without;
      with[Json::json_pointer(place)] = Json::parse(key.value);
      const Outcome a = run(without), b = run(with);
      EXPECT_EQ(a.refused + b.refused, "") << place;
      EXPECT_NE(a.hash, b.hash) << place << " does nothing with " << sweep;
    }
}

}  // namespace
}  // namespace weft
