// The window as a person uses it: real mouse and key events on a screen of the test's own, checked by
// the state that the window tells and by pictures of the screen.
#include <array>
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
  screen.key("Next");
  screen.wait("the next scene from above its floor", [](const Json& now) {
    return now["scene"] != "hello" && now["eye"][1] > now["target"][1];
  });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// The grid of a scene without a floor hides nothing.
TEST_F(Window, ClothIsSeenFromBelowThroughAGrid) {
  Screen screen(folder);
  screen.open("pinned2 --paused");
  EXPECT_EQ(screen.now()["floor"], false);
  screen.drag({{1250, 700}, {1250, 400}, {1250, 60}}, "a view from below",
              [](const Json& now) { return now["eye"][1] < -0.3; });
  screen.wait_picture("the cloth through the floor", [](const std::string& rgb) {
    std::size_t red = 0;
    for (std::size_t k = 0; k + 2 < rgb.size(); k += 3)
      red += static_cast<unsigned char>(rgb[k]) > 1.3 * static_cast<unsigned char>(rgb[k + 2]);
    return red > 10000;
  });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// The direction through a pixel of the picture beside the panel, whose middle is (808, 400) here.
std::array<double, 3> ray_through(const Json& now, int x, int y) {
  std::array<double, 3> f{};
  for (std::size_t k = 0; k < 3; ++k)
    f[k] = (now["target"][k].get<double>() - now["eye"][k].get<double>()) /
           apart(now["eye"], now["target"]);
  const double level = std::hypot(f[0], f[2]), t = std::tan(0.3) / 400;
  const std::array<double, 3> right{-f[2] / level, 0, f[0] / level},
      up{-f[0] * f[1] / level, level, -f[2] * f[1] / level};
  for (std::size_t k = 0; k < 3; ++k) f[k] += t * ((x - 808) * right[k] + (400 - y) * up[k]);
  return f;
}

// How far a point lies from the ray.
double beside(const Json& now, const Json& point, int x, int y) {
  const std::array<double, 3> ray = ray_through(now, x, y);
  double along = 0, square = 0, from = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double p = point[k].get<double>() - now["eye"][k].get<double>();
    along += p * ray[k], square += ray[k] * ray[k], from += p * p;
  }
  return std::sqrt(std::max(0.0, from - along * along / square));
}

// A small ball far from the middle of the view stays under the pointer.
TEST_F(Window, OrbitAndZoomAreAboutWhatIsUnderThePointer) {
  folder.write("ball.json", R"({"weft": 1, "camera": {"azimuth": 0, "elevation": 0},
      "cloths": [{"grid": {"points": [20, 20], "origin": [-0.5, 0, 0], "u": [1, 0, 0], "v": [0, -1, 0]},
                  "pins": [[0, 0], [19, 0]]}],
      "colliders": [{"sphere": {"center": [0.3, -0.2, 0.5], "radius": 0.03}}]})");
  Screen screen(folder);
  screen.open("ball.json --paused");
  const Json start = screen.settled(), ball = start["bodies"][0];
  int x = 0, y = 0;
  double nearest = 1e9;
  for (int i = 500; i < 1280; i += 4)
    for (int j = 40; j < 760; j += 4)
      if (const double d = beside(start, ball, i, j); d < nearest) nearest = d, x = i, y = j;
  ASSERT_LT(nearest, 0.01);
  ASSERT_GT(std::hypot(x - 808, y - 400), 80);
  const std::string at = std::to_string(x) + " " + std::to_string(y);
  screen.type("mousemove " + at + " sleep 1 mousedown 2 sleep 1 mousemove " +
              std::to_string(x - 200) + " " + std::to_string(y + 60) + " sleep 1 mouseup 2");
  const Json turned = screen.wait("a turn", [&](const Json& now) {
    return apart(now["eye"], start["eye"]) > 0.5 * apart(start["eye"], start["target"]);
  });
  EXPECT_LT(beside(turned, ball, x, y), 0.04);
  screen.type("mousemove " + at + " sleep 0.5 click --repeat 4 --delay 100 4");
  const Json near = screen.wait("nearer", [&](const Json& now) {
    return apart(now["eye"], ball) < 0.7 * apart(turned["eye"], ball);
  });
  EXPECT_LT(beside(near, ball, x, y), 0.04);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// Turned, moved and brought down, the eye comes near the floor and never below.
TEST_F(Window, TheCameraStaysAboveASolidFloor) {
  Screen screen(folder);
  screen.open("plane --paused");
  EXPECT_EQ(screen.now()["floor"], true);
  const auto low = [](const Json& now) { return now["eye"][1] < 0.2; };
  screen.drag({{1200, 650}, {1200, 400}, {1200, 60}}, "the floor", low);
  const Json turned = screen.now();
  screen.type(
      "mousemove 800 300 sleep 0.3 mousedown 3 sleep 0.3 mousemove 800 60 sleep 0.3 "
      "mouseup 3 mousemove 800 60 sleep 0.3 mousedown 3 sleep 0.3 mousemove 800 500 "
      "sleep 0.3 mouseup 3");
  screen.wait("a shift", [&](const Json& now) { return now["eye"] != turned["eye"]; });
  screen.type("mousemove 800 700 sleep 0.3 click --repeat 8 --delay 100 4 sleep 0.5");
  screen.key("alt+1");
  screen.wait("the front", [](const Json& now) {
    return std::abs(now["eye"][0].get<double>() - now["target"][0].get<double>()) < 0.01;
  });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  std::ifstream log(folder / "log");
  for (std::string line; std::getline(log, line);)
    ASSERT_GT(Json::parse(line)["eye"][1], 0) << line;
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

TEST_F(Window, TheGalleryShowsPicturesAndOpensWhatIsClicked) {
  Screen screen(folder);
  screen.open("hello --paused");
  screen.click("Scenes");
  screen.wait("the gallery", [](const Json& now) {
    return now["controls"].contains("gallery box_drape") &&
           now["controls"].contains("gallery coat");
  });
  // A picture has light and dark, a button alone has not.
  const Json at = screen.now()["controls"]["gallery flag_round"];
  screen.wait_picture("a picture of flag_round", [&](const std::string& rgb) {
    const auto most = [&](std::size_t channel) {
      int highest = 0, lowest = 255;
      for (int y = -50; y < 50; ++y)
        for (int x = -60; x < 60; ++x) {
          const auto p = static_cast<std::size_t>(
              3 * (Screen::kWidth * (at[1].get<int>() + y) + at[0].get<int>() + x));
          const int value = static_cast<unsigned char>(rgb[p + channel]);
          highest = std::max(highest, value), lowest = std::min(lowest, value);
        }
      return highest - lowest;
    };
    return most(0) > 80;
  });
  screen.key("Escape");
  screen.wait("it to close",
              [](const Json& now) { return !now["controls"].contains("gallery coat"); });
  EXPECT_EQ(screen.now()["scene"], "hello");
  screen.key("g");
  screen.click("gallery coat");
  screen.wait_for("scene", "coat");
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
