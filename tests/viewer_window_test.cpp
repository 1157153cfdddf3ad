// The window as a person uses it: real mouse and key events on a screen of the test's own, checked by
// the state that the window tells and by pictures of the screen.
#include <set>

#include "screen.h"

namespace weft {
namespace {

using Json = nlohmann::json;

TEST_F(Window, PlaysPausesStepsAndResets) {
  Screen screen(folder);
  screen.open("pinned2");
  screen.wait("some frames", [](const Json& now) { return now["frame"] > 5; });
  screen.key("p");
  const Json paused = screen.wait_for("paused", true);
  screen.key("n");
  screen.wait_for("frame", paused["frame"].get<int>() + 1);
  screen.key("r");
  screen.wait_for("frame", 0);
  screen.key("space");
  screen.wait("frames again", [](const Json& now) { return now["frame"] > 3; });
  screen.key("h");
  screen.wait_for("help", true);
  screen.key("Escape");
  screen.wait_for("help", false);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(Window, EveryLookShowsAtItsKey) {
  Screen screen(folder);
  screen.open("sphere --paused");
  screen.step_to(3);
  std::set<std::string> looks;
  std::string before = screen.picture();
  for (int k = 0; k < 14; ++k) {
    const Json now = screen.now();
    screen.key("l");
    const std::string look = screen.wait(
        "another look", [&](const Json& later) { return later["look"] != now["look"]; })["look"];
    looks.insert(look);
    before = screen.wait_picture(
        look, [&](const std::string& picture) { return difference(picture, before) > 0.05; });
  }
  EXPECT_EQ(looks.size(), 14u);
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

double apart(const Json& a, const Json& b) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += std::pow(a[k].get<double>() - b[k].get<double>(), 2);
  return std::sqrt(sum);
}

TEST_F(Window, TheCameraLooksFromEverySideAndComesHome) {
  Screen screen(folder);
  screen.open("hello --paused");
  const Json home = screen.now();
  const auto view = [&](const std::string& key,
                        const std::function<bool(double, double, double)>& is) {
    screen.key(key);
    return screen.wait(key, [&](const Json& now) {
      double from[3];
      for (std::size_t k = 0; k < 3; ++k)
        from[k] = (now["eye"][k].get<double>() - now["target"][k].get<double>()) /
                  apart(now["eye"], now["target"]);
      return is(from[0], from[1], from[2]);
    });
  };
  view("alt+1", [](double, double, double z) { return z > 0.99; });
  view("alt+2", [](double x, double, double) { return x > 0.99; });
  const std::string side = screen.picture();
  view("alt+3", [](double, double y, double) { return y > 0.99; });
  screen.wait_picture("the cloth from above",
                      [&](const std::string& now) { return difference(now, side) > 1; });

  // Turned about what is clicked, nearer to what is under the pointer.
  screen.key("Home");
  screen.wait("home", [&](const Json& now) { return apart(now["eye"], home["eye"]) < 1e-4; });
  screen.type("mousemove 1000 300 sleep 0.5 click --repeat 3 --delay 100 4");
  const Json near = screen.wait("nearer", [&](const Json& now) {
    return apart(now["eye"], now["target"]) < 0.75 * apart(home["eye"], home["target"]);
  });
  EXPECT_GT(apart(near["target"], home["target"]), 0.02);
  // From below, and home again in the next scene.
  screen.drag({{1150, 300}, {1150, 150}, {1150, 20}}, "a view from below",
              [](const Json& now) { return now["eye"][1] < -0.1; });
  screen.wait_picture("the cloth through the floor", [](const std::string& rgb) {
    std::size_t red = 0;
    for (std::size_t k = 0; k + 2 < rgb.size(); k += 3)
      red += static_cast<unsigned char>(rgb[k]) > 1.3 * static_cast<unsigned char>(rgb[k + 2]);
    return red > 10000;
  });
  screen.key("Next");
  screen.wait("the next scene from above its floor", [](const Json& now) {
    return now["scene"] != "hello" && now["eye"][1] > now["target"][1];
  });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// Cloth that has fallen out of the scene is not looked after.
TEST_F(Window, FramingLeavesOutWhatHasFallenAway) {
  folder.write("fall.json", R"({"weft": 1, "cloths": [
      {"grid": {"points": [20, 20], "u": [1, 0, 0], "v": [0, -1, 0]}, "pins": [[0, 0], [19, 0]]},
      {"grid": {"points": [4, 4], "origin": [0, 1.2, 0], "u": [0.2, 0, 0], "v": [0, 0, 0.2]},
       "velocity": [0, 0, 9]}]})");
  Screen screen(folder);
  screen.open("fall.json --paused");
  const Json start = screen.now();
  EXPECT_EQ(start["floor"], false);
  screen.key("space");
  screen.wait("it to fall", [](const Json& now) { return now["frame"] > 120; });
  screen.key("f");
  screen.wait("a view", [&](const Json& now) { return now["eye"] != start["eye"]; });
  EXPECT_LT(apart(screen.now()["eye"], screen.now()["target"]), 6);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(Window, SearchShowsMatchesAloneAndEscapeDoesNotLeave) {
  Screen screen(folder);
  screen.open("sphere --paused");
  const Json place = screen.now()["controls"]["filter"];
  screen.click("filter");
  screen.type("type radius");
  screen.wait("the radius alone", [](const Json& now) {
    return now["controls"].contains("/colliders/0/sphere/radius") &&
           !now["controls"].contains("silk") && !now["controls"].contains("/solver/iterations");
  });
  EXPECT_EQ(screen.now()["controls"]["filter"], place);
  screen.type("key ctrl+a type sphere");
  screen.wait("all of the sphere", [](const Json& now) {
    return now["controls"].contains("/colliders/0/sphere/radius") &&
           now["controls"].contains("/colliders/0/sphere/center");
  });
  screen.key("Return");
  screen.wait_for("typing", false);
  screen.key("Escape");
  screen.wait("how to leave", [](const Json& now) {
    return now["news"].dump().find("Ctrl+Q") != std::string::npos;
  });
  EXPECT_TRUE(screen.runs());
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(Window, WatchingChangesNoBit) {
  Screen screen(folder);
  screen.open("selfCollision --paused --threads 1");
  screen.step_to(6);
  const std::string hash = screen.now()["hash"];
  EXPECT_EQ(screen.quit(), 0);
  ASSERT_EQ(weft("run selfCollision --frames 6 --report report.json"), 0);
  EXPECT_EQ(Json::parse(folder.read("report.json"))["hash"], hash);
}

TEST_F(Window, ScenesAreOpenedOneAfterTheOther) {
  Screen screen(folder);
  screen.open("box_drape --threads 1");
  std::set<std::string> opened{screen.now()["scene"]};
  for (int k = 0; k < 6; ++k) {
    screen.key("Next");
    opened.insert(screen.wait("the next scene", [&](const Json& now) {
      return !opened.contains(now["scene"]) && now["frame"] > 0;
    })["scene"]);
  }
  EXPECT_EQ(opened.size(), 7u);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(Window, FilesAreFollowedAndBrokenOnesTold) {
  Screen screen(folder);
  const std::string good =
      R"({"weft": 1, "cloths": [{"grid": {"points": [9, 9]}, "pins": [[0, 0], [8, 0]],
          "stiffness": {"structural": 700}}]})";
  folder.write("mine.json", good);
  screen.open("mine.json");
  screen.wait_for("stiffness", 700);
  std::string changed = good;
  changed.replace(changed.find("700"), 3, "800");
  folder.write("mine.json", changed);
  screen.wait_for("stiffness", 800);
  folder.write("mine.json", "{\"weft\": 1, \"cloths\": [{\"dragg\": 1}]}");
  const Json broken =
      screen.wait("a fault", [](const Json& now) { return !now["faults"].empty(); });
  EXPECT_NE(broken["faults"].dump().find("drag"), std::string::npos);
  screen.wait("frames go on", [&](const Json& now) { return now["frame"] > broken["frame"]; });
  folder.write("mine.json", good);
  screen.wait("mended",
              [](const Json& now) { return now["faults"].empty() && now["stiffness"] == 700; });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(Window, BrokenShadersAndPicturesAreTold) {
  Screen screen(folder);
  std::filesystem::copy(WEFT_SOURCE_DIR "/shaders", folder / "shaders");
  screen.open("pinned2 --texture missing.png", "WEFT_SHADERS='" + (folder / "shaders") + "'");
  const Json missing =
      screen.wait("a fault", [](const Json& now) { return !now["faults"].empty(); });
  EXPECT_NE(missing["faults"].dump().find("missing.png"), std::string::npos);
  const std::string good = folder.read("shaders/colour.frag");
  folder.write("shaders/colour.frag", "void main() { nonsense }");
  screen.wait("the shader's fault", [](const Json& now) {
    return now["faults"].dump().find("colour.frag") != std::string::npos;
  });
  const Json before = screen.now();
  screen.wait("frames go on", [&](const Json& now) { return now["frame"] > before["frame"]; });
  folder.write("shaders/colour.frag", good);
  screen.wait("mended", [](const Json& now) {
    return now["faults"].dump().find("colour.frag") == std::string::npos;
  });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(Window, WithoutDisplayOrOpenGlItSaysSo) {
  Screen screen(folder);
  const auto view = [&](const std::string& before) {
    return run(before + " '" WEFT_VIEWER_PROGRAM "' hello 2>err");
  };
  EXPECT_EQ(view("DISPLAY="), 6);
  EXPECT_NE(folder.read("err").find("display"), std::string::npos);
  EXPECT_EQ(view("DISPLAY=" + screen.display() + " MESA_GL_VERSION_OVERRIDE=2.1"), 6);
  EXPECT_NE(folder.read("err").find("OpenGL 3.3"), std::string::npos);
}

TEST_F(Window, ALostWindowLosesNoChanges) {
  Screen screen(folder);
  screen.open("pinned2 --paused");
  screen.click("silk");
  screen.wait_for("edited", true);
  screen.wait("the kept changes", [&](const Json&) { return folder.has("weft/pinned2.json"); });
  screen.end_server();
  EXPECT_LT(screen.finish(), 128);  // no signal
  EXPECT_EQ(weft("check weft/pinned2.json"), 0);
}

}  // namespace
}  // namespace weft
