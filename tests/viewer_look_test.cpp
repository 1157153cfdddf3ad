// Looks, fabrics and the quality of the picture, by keys and in the panel.
#include <set>

#include "screen.h"

namespace weft {
namespace {

using Json = nlohmann::json;

TEST_F(Window, EveryLookShowsAtItsKey) {
  Screen screen(folder);
  screen.open("sphere --paused");
  screen.step_to(3);
  std::set<std::string> looks;
  std::string before = screen.picture();
  for (int k = 0; k < 15; ++k) {
    const Json now = screen.now();
    screen.key("l");
    const std::string look = screen.wait(
        "another look", [&](const Json& later) { return later["look"] != now["look"]; })["look"];
    looks.insert(look);
    before = screen.wait_picture(
        look, [&](const std::string& picture) { return difference(picture, before) > 0.05; });
  }
  EXPECT_EQ(looks.size(), 15u);
  EXPECT_TRUE(screen.now()["faults"].empty()) << screen.now()["faults"];
  EXPECT_EQ(screen.quit(), 0);
}

TEST_F(Window, LooksHaveControlsOfTheirOwn) {
  Screen screen(folder);
  screen.open("sphere --paused");
  screen.wait("hints", [](const Json& now) { return now["controls"].contains("hints"); });
  screen.click(1200, 600);  // beside the cloth; hints go at the first touch
  screen.wait("none", [](const Json& now) { return !now["controls"].contains("hints"); });
  screen.click("Look");
  screen.click("look pbr");
  screen.wait_for("look", "pbr");
  screen.wait("its controls", [](const Json& now) { return now["controls"].contains("metallic"); });
  // Each changes the picture; what is drawn at rest is in full quality, and so always the same.
  const auto settled = [&](const std::string& than) {
    screen.type("mousemove 100 790");  // off the control, so that no help covers the picture
    screen.wait_picture("another picture",
                        [&](const std::string& now) { return difference(now, than) > 0.01; });
    screen.wait_for("coarse", false);
    return screen.picture();
  };
  const std::string standard = settled("");
  std::string before = standard;
  for (const char* control : {"floor", "shadow", "roughness", "metallic"}) {
    screen.click(control);
    before = settled(before);
  }
  screen.click("Standard look");
  before = settled(before);
  EXPECT_LT(difference(before, standard), 0.01);

  screen.click("look wireframe");
  screen.wait("its controls", [](const Json& now) {
    return now["controls"].contains("structural") && !now["controls"].contains("metallic");
  });
  before = settled(before);
  screen.click("structural");
  before = settled(before);
  screen.click("Measures");
  screen.wait("the other tab", [](const Json& now) { return !now["controls"].contains("floor"); });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// A fabric is worn, a fine picture is darker in places, and a quick one coarser.
TEST_F(Window, FabricsAreWornAndQualityIsChosen) {
  Screen screen(folder);
  screen.open("sphere --paused");
  screen.step_to(2);
  std::string before = screen.picture();
  screen.click("denim");
  screen.wait_for("look", "fabric");
  screen.type("mousemove 100 790");
  screen.wait_picture("blue cloth", [&](const std::string& rgb) {
    std::size_t blue = 0;
    for (std::size_t k = 0; k + 2 < rgb.size(); k += 3)
      blue += static_cast<unsigned char>(rgb[k + 2]) > 1.35 * static_cast<unsigned char>(rgb[k]);
    return blue > 10000;
  });
  screen.wait_for("coarse", false);
  before = screen.picture();
  screen.click("Look");
  screen.click("quality");
  const Json at = screen.now()["controls"]["quality"];
  screen.type("sleep 0.5 mousemove " + at[0].dump() + " " + std::to_string(at[1].get<int>() + 98) +
              " sleep 0.5 click 1 sleep 0.5 mousemove 100 790");
  screen.wait_picture("a fine picture",
                      [&](const std::string& now) { return difference(now, before) > 0.05; });
  EXPECT_TRUE(screen.now()["faults"].empty()) << screen.now()["faults"];
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

}  // namespace
}  // namespace weft
