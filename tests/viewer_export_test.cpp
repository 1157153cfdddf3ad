// Animations saved from the window: what they hold is what `weft run` writes.
#include <algorithm>

#include "screen.h"

namespace weft {
namespace {

using Json = nlohmann::json;

// Opens the form, and chooses the format.
void choose_format(const Screen& screen, const std::string& format) {
  screen.click("Export");
  const auto offered = [&](const Json& now) {
    for (const auto& [name, at] : now["controls"].items())
      if (name.starts_with("export to ") && name.ends_with(format)) return true;
    return false;
  };
  for (int tries = 0; tries < 5 && !offered(screen.now()); ++tries) {
    screen.click("export " + format);
    screen.type("sleep 1");
  }
  screen.wait("the format", offered);
}

TEST_F(Window, AnExportIsThatOfWeftRun) {
  Screen screen(folder);
  screen.open("pinned2 --paused");
  screen.click("Export");
  screen.click("Start export");
  screen.wait("the export to begin", [](const Json& now) { return tells(now, "pinned2.pc2"); });
  screen.step_to(5);
  EXPECT_FALSE(folder.has("pinned2.pc2"));
  screen.click("Export");
  screen.wait("the export to end", [](const Json& now) { return tells(now, "Written"); });
  EXPECT_EQ(screen.quit(), 0) << screen.said();

  const std::string exported = folder.read("pinned2.pc2");
  ASSERT_EQ(exported.size(), 32u + 6 * 50 * 50 * 12);
  EXPECT_EQ(exported.substr(0, 11), "POINTCACHE2");
  ASSERT_EQ(weft("run pinned2 --frames 5 --export run.pc2"), 0) << folder.read("weft.out");
  EXPECT_TRUE(exported == folder.read("run.pc2"));
}

// The same bytes as of weft run, whatever the format; a scene that is past the first frame starts anew.
TEST_F(Window, ExportsHaveEveryFormatAndTheFramesAskedFor) {
  folder.write("wave.json",
               R"({"weft": 1, "time": {"seconds": 0.2, "frame": 0.02}, "cloths": [{"pins": [[0, 0]],
               "color": {"front": "#2080c0"}, "grid": {"points": [9, 9], "u": [1, 0, 0], "v": [0, 0, 1]}}]})");
  std::filesystem::create_directory(folder / "run");
  Screen screen(folder);
  screen.open("wave.json");
  const auto exported = [&](const std::string& format, const std::string& file) {
    choose_format(screen, format);
    screen.click("Start export");
    screen.wait(format, [&](const Json& now) { return tells(now, "Written: " + file); });
  };
  screen.wait("some frames", [](const Json& now) { return now["frame"] > 15; });
  screen.click("Export");
  screen.click("export endless");
  screen.key("Escape");
  for (const std::string format : {".pc2", ".mdd", ".obj", ".gltf", ".glb", ".usda"}) {
    exported(format, (folder / "wave") + (format == ".obj" ? "_0000.obj" : format));
    ASSERT_EQ(weft("run wave.json --frames 10 --export run/wave" + format), 0)
        << folder.read("weft.out");
    for (const auto& entry : std::filesystem::directory_iterator(folder / "run")) {
      const std::string name = entry.path().filename();
      EXPECT_TRUE(folder.has(name) && folder.read(name) == folder.read("run/" + name)) << name;
    }
  }
  screen.click("Export");
  screen.type_number("first frame", "3");
  screen.type_number("last frame", "7");
  screen.key("Escape");
  exported(".pc2", folder / "wave-2.pc2");
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  constexpr std::size_t kHeader = 32, kFrame = 12 * 9 * 9;
  const std::string all = folder.read("wave.pc2"), some = folder.read("wave-2.pc2");
  ASSERT_EQ(some.size(), kHeader + 5 * kFrame);
  EXPECT_TRUE(some.substr(kHeader) == all.substr(kHeader + 3 * kFrame, 5 * kFrame));
}

// One frame, that which is seen: of a run that was stopped, and of one that was taken back. The run stays where it is.
TEST_F(Window, ThisFrameAloneIsTheClothAsItIsSeen) {
  std::filesystem::create_directory(folder / "run");
  ASSERT_EQ(weft("run pinned2 --frames 6 --export run/pinned2.pc2"), 0) << folder.read("weft.out");
  ASSERT_EQ(weft("run pinned2 --frames 6 --export run/pinned2.obj"), 0) << folder.read("weft.out");
  constexpr std::size_t kHeader = 32, kFrame = 12 * 50 * 50;
  Screen screen(folder);
  screen.open("pinned2 --paused");
  screen.step_to(6);
  const std::string hash = screen.now()["hash"];
  const auto write = [&](const std::string& format, const std::string& file) {
    choose_format(screen, format);
    screen.click("This frame alone");
    screen.wait(file, [&](const Json& now) { return tells(now, "Written: " + (folder / file)); });
  };
  const auto expect_points = [&](const std::string& file, int frame) {
    const std::string all = folder.read("run/pinned2.pc2"), one = folder.read(file);
    ASSERT_EQ(one.size(), kHeader + kFrame) << file;
    EXPECT_TRUE(one.substr(kHeader) ==
                all.substr(kHeader + static_cast<std::size_t>(frame) * kFrame, kFrame))
        << file;
  };
  write(".pc2", "pinned2.pc2");
  expect_points("pinned2.pc2", 6);
  write(".obj", "pinned2_0000.obj");
  EXPECT_TRUE(folder.read("pinned2_0000.obj") == folder.read("run/pinned2_0006.obj"));
  write(".glb", "pinned2.glb");
  EXPECT_EQ(folder.read("pinned2.glb").substr(0, 4), "glTF");
  EXPECT_EQ(folder.read("pinned2.glb").find("\"animations\""), std::string::npos) << "it stands";
  EXPECT_EQ(screen.now()["frame"], 6);
  EXPECT_EQ(screen.now()["hash"], hash);
  EXPECT_TRUE(screen.now()["paused"]);
  for (int frame = 5; frame >= 2; --frame) {
    screen.key("b");
    screen.wait_for("frame", frame);
  }
  write(".pc2", "pinned2-2.pc2");
  expect_points("pinned2-2.pc2", 2);
  screen.key("space");
  screen.wait("some frames", [](const Json& now) { return now["frame"] > 20; });
  write(".pc2", "pinned2-3.pc2");  // while it plays, which it goes on to do
  EXPECT_GT(screen.now()["frame"], 20);
  EXPECT_EQ(folder.read("pinned2-3.pc2").size(), kHeader + kFrame);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

}  // namespace
}  // namespace weft
