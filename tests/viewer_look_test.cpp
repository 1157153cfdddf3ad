// Looks, fabrics and the quality of the picture, by keys and in the panel.
#include <stb_image_write.h>

#include <set>
#include <vector>

#include "screen.h"

namespace weft {
namespace {

using Json = nlohmann::json;

// By a click beside the cloth: hints go at the first touch.
void end_hints(const Screen& screen) {
  screen.wait("hints", [](const Json& now) { return now["controls"].contains("hints"); });
  screen.click(1200, 600);
  screen.wait("none", [](const Json& now) { return !now["controls"].contains("hints"); });
}

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
  end_hints(screen);
  screen.click("Look");
  screen.click("look pbr");
  screen.wait_for("look", "pbr");
  screen.wait("its controls", [](const Json& now) { return now["controls"].contains("metallic"); });
  // Each changes the picture; what is drawn at rest is in full quality, and so always the same.
  const auto settled = [&](const std::string& than) {
    screen.point_aside();
    return screen.settled_picture(
        "another picture", [&](const std::string& now) { return difference(now, than) > 0.01; });
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
  screen.click("denim");
  screen.wait_for("look", "fabric");
  screen.point_aside();
  const std::string before = screen.settled_picture("blue cloth", [&](const std::string& rgb) {
    std::size_t blue = 0;
    for (std::size_t k = 0; k + 2 < rgb.size(); k += 3)
      blue += static_cast<unsigned char>(rgb[k + 2]) > 1.35 * static_cast<unsigned char>(rgb[k]);
    return blue > 10000;
  });
  screen.click("Look");
  screen.click("quality");
  screen.click("quality fine");
  screen.point_aside();
  screen.wait_picture("a fine picture",
                      [&](const std::string& now) { return difference(now, before) > 0.05; });
  EXPECT_TRUE(screen.now()["faults"].empty()) << screen.now()["faults"];
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// Every map of the look pbr is one's own by its field; what cannot be read is told, and the picture before stays.
TEST_F(Window, MapsAreReplacedByFiles) {
  const auto write_plain = [&](const std::string& name, std::vector<unsigned char> rgb) {
    ASSERT_NE(stbi_write_png((folder / name).c_str(), 1, 1, 3, rgb.data(), 0), 0);
  };
  write_plain("color.png", {20, 200, 40});
  write_plain("none.png", {0, 0, 0});
  write_plain("rough.png", {255, 255, 255});
  write_plain("slanted.png", {240, 128, 170});
  folder.write("broken.png", folder.read("color.png").substr(0, 45));
  // The head alone: the size is refused before its 300 MB are asked for.
  const auto text = [](const char* bytes, std::size_t count) { return std::string(bytes, count); };
  folder.write("huge.png", "\x89PNG\r\n\x1a\n" +
                               text("\0\0\0\x0dIHDR\0\0\x27\x10\0\0\x27\x10\x08\x02\0\0\0", 21) +
                               text("\0\0\0\0\0\0\0\0IDAT\0\0\0\0", 16));
  ASSERT_EQ(run("mkfifo pipe.png"), 0);

  Screen screen(folder);
  screen.open("sphere --shader pbr --paused");
  end_hints(screen);
  screen.click("Look");
  screen.wait("its controls", [](const Json& now) { return now["controls"].contains("files"); });
  screen.click("files");
  screen.wait("its fields", [](const Json& now) { return now["controls"].contains("normal map"); });
  const auto enter = [&](const std::string& control, const std::string& path) {
    screen.click(control);
    screen.wait_for("typing", true);
    screen.type("key ctrl+a key BackSpace type '" + path + "'");
    screen.key("Return");
    screen.wait_for("typing", false);
    screen.point_aside();
  };
  const auto changed = [&](const std::string& than) {
    return screen.settled_picture(
        "another picture", [&](const std::string& now) { return difference(now, than) > 0.05; });
  };
  screen.point_aside();
  const auto any = [](const std::string&) { return true; };
  const std::string own = screen.settled_picture("the standard look", any);
  std::string before = own;
  for (const auto& [control, file] : {std::pair("base colour map", "color.png"),
                                      {"metallic map", "none.png"},
                                      {"roughness map", "rough.png"},
                                      {"normal map", "slanted.png"}}) {
    enter(control, file);
    before = changed(before);
    EXPECT_TRUE(screen.now()["faults"].empty()) << screen.now()["faults"];
  }
  for (const char* file : {"broken.png", "missing.png", "huge.png", "pipe.png"}) {
    enter("normal map", file);
    screen.wait("its fault", [&](const Json& now) {
      return now["faults"].dump().find(file) != std::string::npos;
    });
    screen.click("message");  // it covers a part of the picture
    screen.wait("no fault", [](const Json& now) { return now["faults"].empty(); });
    screen.wait_picture("the map before",
                        [&](const std::string& now) { return difference(now, before) < 0.01; });
  }
  screen.click("files");
  screen.wait("room", [](const Json& now) { return now["controls"].contains("Standard look"); });
  screen.click("Standard look");
  screen.point_aside();
  screen.wait_picture("the program's own maps",
                      [&](const std::string& now) { return difference(now, own) < 0.01; });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// Cloths are told apart; a colour that is chosen is that cloth's alone, is saved with the scene and can be undone,
// and changes no bit.
TEST_F(Window, EachClothHasColoursOfItsOwn) {
  Screen screen(folder);
  screen.open("two_sheets --paused");
  end_hints(screen);
  screen.step_to(3);
  screen.wait_for("coarse", false);
  // Pixels beside the panel in which one part of a colour is far above the others.
  const auto count = [](const std::string& rgb, std::size_t part) {
    std::size_t found = 0;
    for (std::size_t k = 0; k + 2 < rgb.size(); k += 3) {
      const auto at = [&](std::size_t which) {
        return static_cast<unsigned char>(rgb[k + which % 3]);
      };
      found += k / 3 % Screen::kWidth > 360 && at(part) > 1.15 * at(part + 1) &&
               at(part) > 1.15 * at(part + 2);
    }
    return found;
  };
  const std::string before = screen.picture();
  const std::size_t red = count(before, 0), green = count(before, 1);
  EXPECT_GT(red, 3000u);
  EXPECT_GT(green, 3000u);
  screen.click("Look");
  const Json at = screen.wait("colours", [](const Json& now) {
    return now["controls"].contains("back 2");
  })["controls"]["back 2"];
  const auto beside = [&](int x, int y) {
    return "mousemove " + std::to_string(at[0].get<int>() + x) + " " +
           std::to_string(at[1].get<int>() + y);
  };
  screen.type(beside(-25, 0) + " sleep 0.5 click 1 sleep 0.5");   // the field, left of its name
  screen.type(beside(30, 170) + " sleep 0.5 click 1 sleep 0.5");  // a grey in the picker
  screen.type("key Escape sleep 0.5");
  screen.point_aside();
  screen.wait_picture("another second cloth", [&](const std::string& now) {
    return count(now, 1) < green / 2 && count(now, 0) > red - red / 10;
  });
  EXPECT_EQ(screen.now()["frame"], 3);
  EXPECT_EQ(screen.now()["undo"], "cloth 1 color back");
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  screen.step_to(6);
  EXPECT_EQ(weft("run two_sheets --frames 6 --threads 1"), 0);
  EXPECT_NE(folder.read("weft.out").find(screen.now()["hash"].get<std::string>()),
            std::string::npos);
  screen.key("ctrl+z");
  screen.wait_picture("the standard colour",
                      [&](const std::string& now) { return count(now, 1) > green - green / 10; });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  const Json saved = Json::parse(folder.read("two_sheets-edited.json"))["cloths"];
  EXPECT_EQ(saved[1]["color"]["back"].get<std::string>().size(), 7u) << saved[1];
  EXPECT_FALSE(saved[0].contains("color")) << saved[0];
}

}  // namespace
}  // namespace weft
