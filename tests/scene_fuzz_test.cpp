// Shipped scenes with bytes or values broken at random: always a clean answer, never a crash, and
// what reads without fault validates, writes and reads back the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "weft/read_scene.h"

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> shipped_texts() {
  std::vector<std::string> texts;
  for (const auto& entry : weft::shipped_scenes()) {
    std::ifstream file(entry.path);
    std::stringstream text;
    text << file.rdbuf();
    texts.push_back(text.str().substr(0, 6000));  // enough of the long lists of pins
    if (text.str().size() <= 6000) continue;
    Json scene = Json::parse(text.str());
    auto& pins = scene["cloths"][0]["pins"];
    pins.erase(pins.begin() + 3, pins.end());
    texts.back() = scene.dump();
  }
  return texts;
}

void expect_clean_answer(const std::string& text) {
  const weft::SceneFile file = weft::read_scene_text(text);
  for (const auto& fault : file.faults) EXPECT_FALSE(fault.what.empty()) << text;
  if (!file.faults.empty()) return;
  for (const auto& fault : weft::validate(file.scene))
    EXPECT_EQ(fault.what, "the mesh is not read") << text;
  EXPECT_EQ(weft::read_scene_text(weft::write_scene_text(file.scene)).scene, file.scene) << text;
}

TEST(SceneFuzz, BrokenBytes) {
  std::mt19937 random(1);
  const std::string bytes = "{}[]\",:0129.eE+-ntf \n\\/\x80\xff";
  for (const std::string& original : shipped_texts())
    for (int round = 0; round < 150; ++round) {
      std::string text = original;
      for (auto k = 1 + random() % 4; k > 0 && !text.empty(); --k) {
        const std::size_t at = random() % text.size();
        switch (random() % 4) {
          case 0:
            text[at] = bytes[random() % bytes.size()];
            break;
          case 1:
            text.erase(at, 1 + random() % 20);
            break;
          case 2:
            text.insert(at, text.substr(random() % text.size(), random() % 20));
            break;
          default:
            text.resize(at + 1);
            break;
        }
      }
      expect_clean_answer(text);
    }
}

TEST(SceneFuzz, BrokenValues) {
  std::mt19937 random(2);
  const std::vector<Json> values = {nullptr,
                                    true,
                                    -1,
                                    0,
                                    3,
                                    1e-300,
                                    1e300,
                                    "auto",
                                    "line",
                                    "",
                                    0.5,
                                    1,
                                    Json::array(),
                                    Json::array({0, 0}),
                                    Json::array({0, 1, 0}),
                                    Json::object(),
                                    Json::parse(R"({"course": 1})"),
                                    18446744073709551615u};
  for (const std::string& original : shipped_texts())
    for (int round = 0; round < 150; ++round) {
      Json scene = Json::parse(original);
      for (auto k = 1 + random() % 3; k > 0; --k) {
        const Json flat = scene.flatten();
        auto leaf = flat.begin();
        std::advance(leaf, static_cast<std::ptrdiff_t>(random() % flat.size()));
        Json::json_pointer place(leaf.key());
        while (!place.empty() && random() % 3 == 0) place.pop_back();
        if (random() % 4 == 0 && !place.empty() && scene[place.parent_pointer()].is_object())
          scene[place.parent_pointer()].erase(place.back());
        else
          scene[place] = values[random() % values.size()];
        if (!scene.is_object()) scene = Json::parse(original);
      }
      expect_clean_answer(scene.dump());
    }
}

}  // namespace
