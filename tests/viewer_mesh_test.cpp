// Meshes of files in the window: as cloth and as bodies, from the panel and dropped.
#include "screen.h"

namespace weft {
namespace {

using Json = nlohmann::json;

constexpr const char* kSheet = R"({"weft": 1, "camera": {"azimuth": 20, "elevation": 20},
    "cloths": [{"grid": {"points": [12, 12], "origin": [-0.5, 1, -0.5]}, "density": 0.2}],
    "colliders": [{"plane": {"point": [0, 0, 0]}}]})";

// A square of n * n quadrilaterals about the origin, of the given side and height.
std::string square(int n, double side, double height) {
  std::string text;
  char line[96];
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      std::snprintf(line, sizeof line, "v %g %g %g\n", side * i / n - side / 2, height,
                    side * j / n - side / 2);
      text += line;
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i + 1, b = a + n + 1;
      std::snprintf(line, sizeof line, "f %d %d %d %d\n", a, b, b + 1, a + 1);
      text += line;
    }
  return text;
}

constexpr const char* kBlock =
    "v -20 0 -20\nv 20 0 -20\nv 20 0 20\nv -20 0 20\nv -20 40 -20\nv 20 40 -20\nv 20 40 20\n"
    "v -20 40 20\nf 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

double share_of_grey(const std::string& rgb) {
  double dark = 0, all = 0;
  for (int y = 300; y < 640; ++y)
    for (int x = 600; x < 1000; ++x, ++all) {
      const auto p = static_cast<std::size_t>(3 * (Screen::kWidth * y + x));
      const int r = static_cast<unsigned char>(rgb[p]), b = static_cast<unsigned char>(rgb[p + 2]);
      dark += r < 115 && std::abs(r - b) < 40;
    }
  return dark / all;
}

TEST_F(Window, AMeshFileBecomesABodyAndAClothThatFallsOnIt) {
  folder.write("sheet.json", kSheet);
  folder.write("block.obj", kBlock);  // in centimeters
  folder.write("cover.obj", square(16, 1.2, 0.7));
  folder.write("broken.obj", "v 0 0 0\nf 1 2 3\n");
  Screen screen(folder);
  screen.open("sheet.json --paused");
  const std::string before = screen.picture();
  screen.click("add mesh");
  screen.click("mesh file broken.obj");
  screen.click("mesh as cloth");  // does nothing
  screen.click("mesh cancel");
  screen.wait("the form closed",
              [](const Json& now) { return !now["controls"].contains("mesh cancel"); });
  EXPECT_EQ(screen.now()["cloths"], 1);

  screen.click("add mesh");
  screen.click("mesh file block.obj");
  screen.click("mesh as body");
  screen.wait("two bodies", [](const Json& now) { return now["bodies"].size() == 2; });
  screen.wait_for("tool", "move");
  EXPECT_EQ(screen.now()["undo"], "add body file");
  const double grey = share_of_grey(before);
  screen.wait_picture("the block",
                      [&](const std::string& now) { return share_of_grey(now) > grey + 0.02; });
  screen.click("add mesh");
  screen.click("mesh file cover.obj");
  screen.click("mesh as cloth");
  screen.wait_for("cloths", 2);
  screen.click("silk");  // the fabrics suit meshes, too
  screen.wait_for("undo", "silk");
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  screen.key("space");
  screen.wait("frames", [](const Json& now) { return now["frame"] > 60; });
  EXPECT_TRUE(screen.now()["faults"].empty()) << screen.now()["faults"];
  EXPECT_EQ(screen.quit(), 0) << screen.said();

  const Json scene = Json::parse(folder.read("sheet.json"));
  EXPECT_EQ(scene["colliders"][1]["mesh"]["file"], "block.obj");
  EXPECT_EQ(scene["colliders"][1]["mesh"]["scale"], 0.01);
  EXPECT_EQ(scene["cloths"][1]["mesh"]["file"], "cover.obj");
  EXPECT_NEAR(scene["cloths"][1]["density"], 0.08, 1e-12);
  EXPECT_EQ(weft("run sheet.json --frames 3"), 0) << folder.read("weft.out");
}

#ifdef WEFT_DROP_PROGRAM

TEST_F(Window, DroppedMeshesAskWhatTheyAre) {
  folder.write("sheet.json", kSheet);
  folder.write("block.obj", kBlock);
  folder.write("a cover.obj", square(8, 0.5, 1.5));
  Screen screen(folder);
  screen.open("sheet.json --paused");
  screen.drop("block.obj 'a cover.obj'");
  screen.click("mesh as body");
  screen.wait("a body", [](const Json& now) { return now["bodies"].size() == 2; });
  screen.wait("the next question",
              [](const Json& now) { return now["controls"].contains("mesh as cloth"); });
  screen.click("mesh as cloth");
  screen.wait_for("cloths", 2);
  screen.key("ctrl+z");
  screen.wait_for("cloths", 1);
  screen.key("ctrl+z");
  screen.wait("no body", [](const Json& now) { return now["bodies"].size() == 1; });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

#endif

}  // namespace
}  // namespace weft
