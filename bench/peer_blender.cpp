// Blender's cloth (peer_blender.h).
#include "peer_blender.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace bench {
namespace {

using nlohmann::json;

// Blender looks for its Python's packages beside the first python3 on the path: the system's has them.
const std::string kPath = "PATH=/usr/bin:/bin:\"$PATH\" ";
// One thread, as the others have: its solver takes those of OpenMP besides its own.
const std::string kBlender = kPath + "OMP_NUM_THREADS=1 blender -b -t 1 --factory-startup ";

// A folder that is gone when it goes out of scope.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "weft-blender-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no folder for Blender's files: " + name);
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

// Pins that turn alike, as one hook.
json turns_of(const weft::Cloth& cloth) {
  std::vector<std::pair<weft::Rotation, std::vector<int>>> turns;
  for (const weft::Pin& pin : cloth.pins) {
    if (pin.rotate.keys.empty()) continue;
    const int particle = weft::particle_number(cloth.grid, pin.i, pin.j);
    if (turns.empty() || !(turns.back().first == pin.rotate)) turns.push_back({pin.rotate, {}});
    turns.back().second.push_back(particle);
  }
  json all = json::array();
  for (const auto& [rotation, vertices] : turns) {
    std::vector<double> degrees;
    for (const weft::Angle& key : rotation.keys) degrees.push_back(key.degrees);
    all.push_back({{"axis", rotation.axis},
                   {"about", rotation.about},
                   {"degrees", degrees},
                   {"vertices", vertices}});
  }
  return all;
}

json ball_of(const weft::Scene& scene) {
  if (scene.colliders.empty()) return nullptr;
  const auto* sphere = std::get_if<weft::Sphere>(&scene.colliders[0].shape);
  if (!sphere) throw std::invalid_argument("of bodies Blender is given balls alone");
  return {{"center", sphere->center},
          {"radius", sphere->radius},
          {"friction", scene.colliders[0].friction.dynamic}};
}

json sheet_of(const weft::Scene& scene, double seconds,
              const std::vector<BlenderSetting>& settings) {
  const weft::Cloth& cloth = scene.cloths[0];
  const weft::Grid& g = cloth.grid;
  double mass = 0;  // the same for all vertices: it knows no others
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) mass += weft::particle_mass(cloth, i, j) / (g.nx * g.ny);
  json held = json::array(), runs = json::array();
  for (const weft::Pin& pin : cloth.pins) held.push_back(weft::particle_number(g, pin.i, pin.j));
  for (const BlenderSetting& s : settings) runs.push_back({s.frames, s.substeps});
  return {{"nx", g.nx},
          {"ny", g.ny},
          {"origin", g.origin},
          {"u", g.u},
          {"v", g.v},
          {"mass", mass},
          {"structural", cloth.stiffness.structural},
          {"shear", cloth.stiffness.shear},
          {"bending", cloth.bending.warp},
          {"drag", cloth.drag},
          {"gravity", scene.gravity},
          {"seconds", seconds},
          {"held", held},
          {"turns", turns_of(cloth)},
          {"ball", ball_of(scene)},
          {"runs", runs}};
}

}  // namespace

std::string without_blender() {
  static const bool here = std::system((kPath + "command -v blender >/dev/null 2>&1").c_str()) == 0;
  return here ? "" : "it is not installed (apt-get install blender)";
}

std::vector<BlenderRun> run_blender(const weft::Scene& scene, double seconds,
                                    const std::vector<BlenderSetting>& settings) {
  const Folder folder;
  const std::string asked = folder.file("sheet.json"), told = folder.file("told.json"),
                    said = folder.file("said.txt");
  std::ofstream(asked) << sheet_of(scene, seconds, settings);
  const std::string command = kBlender + "--python-exit-code 1 -P '" WEFT_BLENDER_SCRIPT "' -- '" +
                              asked + "' '" + told + "' >'" + said + "' 2>&1";
  const int status = std::system(command.c_str());
  std::ifstream in(told);
  if (status != 0 || !in) {
    std::ifstream text(said);
    const std::string all{std::istreambuf_iterator<char>(text), {}};
    throw std::runtime_error("Blender, which failed: " +
                             all.substr(all.size() > 2000 ? all.size() - 2000 : 0));
  }
  std::vector<BlenderRun> runs;
  for (const json& run : json::parse(in))
    runs.push_back({run.at("ms"), run.at("positions").get<std::vector<double>>()});
  return runs;
}

}  // namespace bench
