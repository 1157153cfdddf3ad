// Colours of cloths and bodies: what a text means, files there and back, recordings and exports; and that a run looks
// at none of them.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "folder.h"
#include "weft/read_scene.h"
#include "weft/recording.h"

namespace weft {
namespace {

using nlohmann::json;

// Two sheets that fall onto two balls.
Scene two_sheets() {
  Scene scene = read_scene("two_sheets").scene;
  for (Cloth& cloth : scene.cloths) cloth.grid.nx = cloth.grid.ny = 12;
  for (Cloth& cloth : scene.cloths) cloth.pins.clear();
  scene.colliders = {{.shape = Sphere{{0, 0.2, 0}, 0.2}, .friction = {}, .keys = {}},
                     {.shape = Sphere{{0.3, 0.2, 0}, 0.2}, .friction = {}, .keys = {}}};
  return scene;
}

Scene colored(Scene scene) {
  scene.cloths[0].color = {"#ff0000", "#0000FF"};
  scene.cloths[1].color.front = "#00bc0a";
  scene.colliders[1].color = "#808080";
  return scene;
}

std::vector<std::uint64_t> hashes_of(Simulation& simulation, int frames) {
  std::vector<std::uint64_t> hashes;
  for (int n = 0; n < frames; ++n) {
    simulation.advance_frame();
    hashes.push_back(simulation.hash());
  }
  return hashes;
}

// Against the curve of IEC 61966-2-1, which is steep where it is not a line: half of the light is near #bc.
TEST(Color, IsRedGreenAndBlueInProportionToLight) {
  EXPECT_EQ(linear_color("#000000"), (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(linear_color("#ffffff"), (std::array<double, 3>{1, 1, 1}));
  const auto mixed = linear_color("#bC0AfF");
  ASSERT_TRUE(mixed);
  EXPECT_NEAR((*mixed)[0], 0.502886, 1e-6);
  EXPECT_NEAR((*mixed)[1], 10 / 255.0 / 12.92, 1e-12);
  EXPECT_EQ((*mixed)[2], 1);
  std::array<double, 3> before{-1, -1, -1};
  for (int part = 0; part < 256; ++part) {
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "#%02x%02x%02X", part, part, part);
    const auto color = linear_color(text.data());
    ASSERT_TRUE(color) << text.data();
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_GT((*color)[k], before[k]) << text.data();
      const double c = (*color)[k];
      EXPECT_NEAR(c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055, part / 255.0,
                  1e-6);
    }
    before = *color;
  }
  for (const char* wrong : {"", "#", "red", "#fff", "ffffff", "#fffffff", "#ff ff0", "#-1ff00",
                            "#+1ff00", "#gg0000", "#00000g", "#0x1100"})
    EXPECT_FALSE(linear_color(wrong)) << wrong;
}

TEST(Color, IsReadBackAsItWasWritten) {
  const Scene scene = colored(two_sheets());
  const SceneFile file = read_scene_text(write_scene_text(scene));
  ASSERT_TRUE(file.faults.empty()) << file.faults[0].what;
  EXPECT_EQ(file.scene, scene);
  EXPECT_TRUE(moves_alike(scene, two_sheets()));
  Scene other = scene;
  other.cloths[1].drag += 1;
  EXPECT_FALSE(moves_alike(scene, other));
  const json plain = json::parse(write_scene_text(two_sheets()));
  EXPECT_FALSE(plain["cloths"][0].contains("color")) << "none: no key";
}

TEST(Color, OfAnotherFormIsRefused) {
  Scene scene = two_sheets();
  scene.cloths[1].color.back = "#12345";
  scene.colliders[0].color = "blue";
  const std::vector<Fault> faults = validate(scene);
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[0].place, "/cloths/1/color/back");
  EXPECT_EQ(faults[0].what, "back is \"#12345\"");
  EXPECT_EQ(faults[1].place, "/colliders/0/color");
  EXPECT_EQ(faults[1].what, "color is \"blue\"");
  EXPECT_THROW(Simulation{scene}, SceneError);
  Simulation simulation(two_sheets());
  EXPECT_THROW(simulation.draw_as(scene), SceneError);
  EXPECT_FALSE(simulation.view().cloths[1].color);
}

// Word for word, with the place, the value and what is allowed.
TEST(Color, FaultsAreNamed) {
  const auto told = [](const char* text) {
    std::string all;
    for (const Fault& fault : read_scene_text(text).faults)
      all += fault.place + ": " + fault.what + " (" + fault.allowed + ")\n";
    return all;
  };
  EXPECT_EQ(
      told(
          R"({"weft": 1, "cloths": [{"color": {"front": "#12ab", "back": "#12345g"}}, {"color": {"front": "#0Af9c3"}}]})"),
      "/cloths/0/color/front: front is \"#12ab\" (#rrggbb in hexadecimal digits, or nothing)\n"
      "/cloths/0/color/back: back is \"#12345g\" (#rrggbb in hexadecimal digits, or nothing)\n");
  EXPECT_EQ(
      told(
          R"({"weft": 1, "cloths": [{"color": {"front": [1.5, 0, 0], "back": "#12345678", "side": ""}}], "colliders": [{"sphere": {}, "color": "red"}]})"),
      "/cloths/0/color/front: front is [1.5, 0, 0] (text)\n"
      "/cloths/0/color/back: back is \"#12345678\" (#rrggbb in hexadecimal digits, or nothing)\n"
      "/cloths/0/color/side: unknown key \"side\" (the nearest known key is \"back\")\n"
      "/colliders/0/color: color is \"red\" (#rrggbb in hexadecimal digits, or nothing)\n");
}

// From the start, taken over while it runs, or with another value of the scene: the same bits as without.
TEST(Color, ChangesNoBitOfARun) {
  constexpr int kFrames = 20;
  for (const int threads : {1, 2}) {
    const Options options{.threads = threads};
    Simulation plain(two_sheets(), options);
    Simulation from_start(colored(two_sheets()), options);
    Simulation later(two_sheets(), options);
    const auto before = hashes_of(plain, kFrames);
    EXPECT_EQ(hashes_of(from_start, kFrames), before);
    EXPECT_EQ(hashes_of(later, kFrames), before);
    later.draw_as(colored(two_sheets()));
    EXPECT_EQ(later.scene(), from_start.scene());
    EXPECT_EQ(later.view().cloths[0].color, (std::array<double, 3>{1, 0, 0}));
    EXPECT_EQ(hashes_of(later, kFrames), hashes_of(plain, kFrames));
    Scene heavier = two_sheets();
    heavier.cloths[0].drag += 1;
    later.set_scene(heavier);  // and without colours
    plain.set_scene(heavier);
    EXPECT_EQ(hashes_of(later, kFrames), hashes_of(plain, kFrames));
  }
}

// A scene far from zero has a copy of itself about its own origin: both take the colours.
TEST(Color, IsTakenOverFarFromZero) {
  const Scene far = moved(two_sheets(), {1000, 0, 0});
  Simulation simulation(far);
  simulation.draw_as(colored(far));
  EXPECT_EQ(simulation.scene(), colored(far));
  EXPECT_EQ(simulation.view().cloths[0].color, (std::array<double, 3>{1, 0, 0}));
}

TEST(Color, IsInRecordings) {
  const Folder folder;
  const Scene scene = colored(two_sheets());
  Simulation simulation(scene);
  Recorder recorder(folder / "a.rec", simulation);
  simulation.advance_frame();
  recorder.frame(simulation);
  recorder.finish();
  EXPECT_EQ(read_recording(folder / "a.rec").scene, scene);
}

// Formats with materials or colours have that of the front; a cloth without one has none there.
TEST(Color, IsInExports) {
  const Folder folder;
  Scene scene = colored(two_sheets());
  scene.cloths[0].color = {.front = "", .back = "#ff0000"};
  const Simulation simulation(scene);
  for (const char* name : {"a.gltf", "a.usda"}) {
    const auto animation = open_animation(folder / name, simulation.view());
    animation->append(simulation.view());
    animation->finish();
  }
  const auto color = linear_color(scene.cloths[1].color.front);
  const json gltf = json::parse(folder.read("a.gltf"));
  const auto material = [&](std::size_t c) {
    const auto number = gltf["meshes"][c]["primitives"][0]["material"].get<std::size_t>();
    return gltf["materials"].at(number);
  };
  EXPECT_EQ(material(0), json::parse(R"({"doubleSided": true})"));
  const json surface = material(1)["pbrMetallicRoughness"];
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(surface["baseColorFactor"][k].get<double>(), (*color)[k]);
  EXPECT_EQ(surface["baseColorFactor"][3], 1);
  EXPECT_EQ(surface["metallicFactor"], 0);
  const std::string usda = folder.read("a.usda");
  const std::string key = "color3f[] primvars:displayColor = [(";
  const std::size_t second = usda.find("\"cloth_1\""), at = usda.find(key);
  ASSERT_NE(at, std::string::npos);
  EXPECT_GT(at, second);
  EXPECT_EQ(usda.find(key, at + 1), std::string::npos);
  std::istringstream values(usda.substr(at + key.size()));
  for (std::size_t k = 0; k < 3; ++k) {
    double value = -1;
    char comma = 0;
    values >> value >> comma;
    EXPECT_EQ(static_cast<float>(value), static_cast<float>((*color)[k]));
    EXPECT_EQ(comma, k < 2 ? ',' : ')');
  }
}

}  // namespace
}  // namespace weft
