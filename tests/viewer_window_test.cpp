// The window as a person uses it: real mouse and key events on a screen of the test's own, checked by
// the state that the window tells and by pictures of the screen.
#include <cstring>
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

TEST_F(Window, HandsPullPinAndCutTheCloth) {
  Screen screen(folder);
  screen.open("pinned2 --record session");
  screen.wait("the sheet to hang", [](const Json& now) { return now["frame"] > 150; });
  const std::string before = screen.picture();
  const Json start = screen.now();
  screen.drag({{850, 420}, {900, 400}, {1000, 350}}, "frames with a hand",
              [&](const Json& now) { return now["frame"] > start["frame"].get<int>() + 100; });
  screen.key("2");
  screen.wait_for("tool", "pin");
  screen.click(900, 430);
  screen.wait_for("held", 3);
  EXPECT_EQ(screen.now()["undo"], "pin");
  screen.key("3");
  screen.wait_for("tool", "cut");
  screen.drag({{760, 480}, {800, 490}, {840, 500}, {880, 510}, {920, 520}, {960, 530}}, "a cut",
              [](const Json& now) { return now["torn"] == true; });
  const Json cut = screen.now();
  EXPECT_LT(cut["triangles"], 2 * 49 * 49);
  EXPECT_GT(difference(screen.picture(), before), 0.5);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  const std::string session = folder.read("session");
  for (const char* input : {"\"grab\"", "\"release\"", "\"set_scene\""})
    EXPECT_NE(session.find(input), std::string::npos) << input;
  EXPECT_EQ(weft("run pinned2 --replay session"), 0) << folder.read("weft.out");
}

// A stroke from beside the swinging sheet to beside it: what lies below falls, in the window and from the
// saved file; undone, the sheet hangs as it did.
TEST_F(Window, ACutFromBesideToBesideSevers) {
  Screen screen(folder);
  screen.open("pinned2");
  screen.wait("the sheet to swing", [](const Json& now) { return now["frame"] > 60; });
  screen.key("3");
  screen.wait_for("tool", "cut");
  screen.drag({{520, 360}, {700, 370}, {850, 375}, {1000, 380}, {1150, 385}, {1260, 390}}, "a cut",
              [](const Json& now) { return now["torn"] == true; });
  EXPECT_EQ(screen.now()["undo"], "cut");
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  const Json saved = Json::parse(folder.read("pinned2-edited.json"))["cloths"][0]["cuts"];
  ASSERT_FALSE(saved.empty());
  for (const Json& line : saved)
    for (const Json& end : {line.front(), line.back()})
      EXPECT_TRUE(end[0] < 0 || end[0] > 49 || end[1] < 0 || end[1] > 49) << line;
  ASSERT_EQ(weft("run pinned2-edited.json --seconds 6 --dump final.f64"), 0)
      << folder.read("weft.out");
  const std::string bytes = folder.read("final.f64");
  double lowest = 0;
  for (std::size_t at = 0; at + 24 <= bytes.size(); at += 24) {
    double y = 0;
    std::memcpy(&y, bytes.data() + at + 8, sizeof y);
    lowest = std::min(lowest, y);
  }
  EXPECT_LT(lowest, -2);  // held, the sheet reaches to -1; the course damps the fall

  screen.key("r");
  screen.wait("the cut sheet from its start",
              [](const Json& now) { return now["frame"] < 60 && now["torn"] == true; });
  screen.key("ctrl+z");
  screen.wait_for("torn", false);
  screen.key("ctrl+y");
  screen.wait_for("torn", true);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(Window, ALassoPinsAndLetsGo) {
  Screen screen(folder);
  screen.open("pinned4 --paused");
  screen.step_to(1);
  screen.key("2");
  screen.wait_for("tool", "pin");
  const std::vector<std::pair<int, int>> round{{700, 180}, {1000, 200}, {1000, 300}, {700, 280}};
  screen.drag(round, "the lasso", [](const Json& now) { return now["busy"] == true; });
  const Json pinned = screen.wait("pins", [](const Json& now) { return now["held"] > 20; });
  EXPECT_EQ(pinned["undo"], "pin");
  screen.key("r");
  screen.wait_for("frame", 0);
  EXPECT_EQ(screen.now()["held"], pinned["held"]);
  screen.key("ctrl+z");
  screen.wait_for("held", 4);
  screen.key("ctrl+y");
  screen.wait_for("held", pinned["held"]);
  // All within are pinned: a lasso inside of the first lets go.
  screen.drag({{740, 190}, {900, 200}, {900, 205}, {740, 198}}, "a smaller lasso",
              [](const Json& now) { return now["busy"] == true; });
  screen.wait("fewer pins",
              [&](const Json& now) { return now["held"] < pinned["held"] && now["held"] > 4; });
  EXPECT_EQ(screen.now()["undo"], "unpin");
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

// Against gravity: without aim it would pass some 0.3 m below where it was shot at.
TEST_F(Window, ABallMeetsWhatIsClicked) {
  folder.write("sheet.json", R"({"weft": 1, "camera": {"azimuth": 0, "elevation": 0},
      "cloths": [{"grid": {"points": [30, 30], "u": [1, 0, 0], "v": [0, -1, 0]},
                  "pins": [[0, 0], [29, 0], [0, 29], [29, 29]]}]})");
  Screen screen(folder);
  screen.open("sheet.json");
  screen.key("5");
  screen.wait_for("tool", "ball");
  const Json before = screen.now();
  screen.click(808, 400);  // the middle of the picture: what the camera looks at
  const Json shot =
      screen.wait("a ball", [](const Json& now) { return now["bodies"].size() == 1; });
  EXPECT_EQ(shot["undo"], "ball");
  // It comes through the sheet's plane within 6 cm of there.
  double nearest = 1e9, at_x = 0, at_y = 0;
  screen.wait("the ball to have passed", [&](const Json& now) {
    const Json& ball = now["bodies"][0];
    if (std::abs(ball[2].get<double>()) < nearest)
      nearest = std::abs(ball[2].get<double>()), at_x = ball[0], at_y = ball[1];
    return ball[2].get<double>() < -0.1;
  });
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  const Json keys = Json::parse(folder.read("sheet.json"))["colliders"][0]["keys"];
  for (std::size_t k = 1; k < keys.size(); ++k) {
    const double z0 = keys[k - 1][3], z1 = keys[k][3];
    if (z0 < 0 || z1 > 0) continue;
    const double t = z0 / (z0 - z1);
    const auto along = [&](std::size_t c) {
      return keys[k - 1][c].get<double>() * (1 - t) + keys[k][c].get<double>() * t;
    };
    EXPECT_NEAR(along(1), before["target"][0].get<double>(), 0.06);
    EXPECT_NEAR(along(2), before["target"][1].get<double>(), 0.06);
  }
  EXPECT_LT(nearest, 1);
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

TEST_F(Window, ChangesAreCheckedUndoneAndSaved) {
  Screen screen(folder);
  screen.open("pinned4 --paused");
  const double start = screen.now()["stiffness"];
  screen.click("denim");
  const Json denim =
      screen.wait("denim", [&](const Json& now) { return now["stiffness"] != start; });
  EXPECT_EQ(denim["edited"], true);
  screen.key("ctrl+z");
  screen.wait_for("stiffness", start);
  screen.key("ctrl+y");
  screen.wait_for("stiffness", denim["stiffness"]);
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  EXPECT_EQ(weft("check pinned4-edited.json"), 0) << folder.read("weft.out");
  EXPECT_EQ(Json::parse(folder.read("pinned4-edited.json"))["cloths"][0]["stiffness"]["structural"],
            denim["stiffness"]);

  // A value beyond its range is brought back into it.
  screen.click("filter");
  screen.type("type iterations");
  screen.wait("one control left", [](const Json& now) {
    return now["controls"].contains("/solver/iterations") &&
           !now["controls"].contains("/cloths/0/density");
  });
  const Json at = screen.now()["controls"]["/solver/iterations"];
  screen.key("Return");  // leaves the filter
  screen.wait_for("typing", false);
  screen.type("mousemove 60 " + std::to_string(at[1].get<int>()) +
              " sleep 1 keydown ctrl sleep 1 mousedown 1 sleep 1 mouseup 1 sleep 1 keyup ctrl");
  screen.wait_for("typing", true);
  screen.type("key ctrl+a sleep 1 type 999999");
  screen.key("Return");
  screen.wait_for("typing", false);
  EXPECT_EQ(screen.now()["edited"], true);
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  EXPECT_EQ(Json::parse(folder.read("pinned4-edited.json"))["solver"]["iterations"], 1000);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(Window, PathsAreEditedKeyByKey) {
  Screen screen(folder);
  folder.write("path.json",
               R"({"weft": 1, "cloths": [{"grid": {"points": [9, 9]}, "pins": [[0, 0]]}],
    "colliders": [{"sphere": {"center": [0, -2, 0], "radius": 0.2},
                   "keys": [[0, 0, -2, 0], [1, 1, -2, 0], [2, 0, -3, 0]]}]})");
  screen.open("path.json --paused");
  const auto filter = [&](const std::string& word, const std::string& control) {
    screen.click("filter");
    screen.type("key ctrl+a type " + word);
    screen.wait(control, [&](const Json& now) { return now["controls"].contains(control); });
    screen.key("Return");  // leaves the filter
    screen.wait_for("typing", false);
    screen.click(control);
  };
  filter("keys", "/colliders/0/keys");
  screen.click("/colliders/0/keys remove 1");
  screen.wait("two keys", [](const Json& now) {
    return !now["controls"].contains("/colliders/0/keys remove 2");
  });
  screen.click("/colliders/0/keys add");
  screen.wait("a third key again", [](const Json& now) {
    return now["controls"].contains("/colliders/0/keys remove 2");
  });
  filter("pins", "/cloths/0/pins");
  screen.click("/cloths/0/pins/0");
  screen.click("/cloths/0/pins/0 add");
  screen.wait("a key", [](const Json& now) {
    return now["controls"].contains("/cloths/0/pins/0 remove 0");
  });
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  EXPECT_EQ(weft("check path.json"), 0) << folder.read("weft.out");
  const Json saved = Json::parse(folder.read("path.json"));
  EXPECT_EQ(saved["colliders"][0]["keys"],
            Json::parse("[[0, 0, -2, 0], [2, 0, -3, 0], [2.5, 0, -3, 0]]"));
  EXPECT_EQ(saved["cloths"][0]["pins"][0]["keys"].size(), 1u);

  // Undone key by key, to the pin without a path.
  screen.key("ctrl+z");
  screen.wait("no key", [](const Json& now) {
    return !now["controls"].contains("/cloths/0/pins/0 remove 0");
  });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// Gravity and wind as vectors and along keys; a pin that turns keeps its axis when it gets a path.
TEST_F(Window, ValuesOverTimeAreEditedToo) {
  const char* keys = R"({"keys": [[0, 1, 0, 0], [1, 2, 0, 0]]})";
  folder.write("over.json", std::string(R"({"weft": 1, "gravity": )") + keys +
                                R"(, "wind": {"velocity": [3, 0, 0], "drag": 0.1}, "cloths": [
          {"grid": {"points": [4, 4]}, "pins": [{"at": [0, 0], "rotate": {"axis": [0, 1, 0],
           "keys": [[0, 0], [1, 90]]}}]}]})");
  Screen screen(folder);
  screen.open("over.json --paused");
  const auto look_for = [&](const std::string& name, const std::string& control) {
    screen.click("filter");
    screen.type("key ctrl+a type " + name);
    screen.wait(name, [&](const Json& now) { return now["controls"].contains(control); });
    screen.key("Return");
    screen.wait_for("typing", false);
  };
  look_for("wind", "/wind/velocity");
  look_for("gravity", "/gravity/keys");
  screen.click("/gravity/keys");
  for (const char* remove : {"/gravity/keys remove 1", "/gravity/keys remove 0"})
    screen.click(remove);
  screen.wait("a plain vector",
              [](const Json& now) { return now["controls"].contains("/gravity"); });
  look_for("pins", "/cloths/0/pins");
  screen.click("/cloths/0/pins");
  screen.click("/cloths/0/pins/0");
  screen.click("/cloths/0/pins/0 add");
  screen.wait("a key", [](const Json& now) {
    return now["controls"].contains("/cloths/0/pins/0 remove 0");
  });
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  const Json saved = Json::parse(folder.read("over.json"));
  EXPECT_EQ(saved["gravity"], Json::parse("[1.0, 0.0, 0.0]"));
  const Json& pin = saved["cloths"][0]["pins"][0];
  EXPECT_EQ(pin["keys"].size(), 1u) << pin;
  EXPECT_EQ(pin["rotate"]["keys"].size(), 2u) << pin;
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

TEST_F(Window, BodiesMoveByKeysAndAsBallsAndTheWayBackIsKept) {
  Screen screen(folder);
  screen.open("seed1_friction --paused");
  screen.step_to(2);
  screen.key("space");
  const Json before = screen.wait_for("paused", false);
  screen.type("keydown Right sleep 2 keyup Right");
  screen.wait("the sphere to move and stay", [&](const Json& now) {
    return now["edited"] == true && now["bodies"][0] != before["bodies"][0];
  });
  const auto bodies = screen.now()["bodies"].size();
  screen.key("5");
  screen.wait_for("tool", "ball");
  screen.click(760, 300);
  screen.wait("a ball", [&](const Json& now) { return now["bodies"].size() == bodies + 1; });
  const Json running = screen.now();
  screen.wait("more frames",
              [&](const Json& now) { return now["frame"] > running["frame"].get<int>() + 5; });
  screen.key("p");
  const Json paused = screen.wait_for("paused", true);
  screen.key("b");
  const Json back = screen.wait_for("back", 1);
  // Frames are kept as often as that costs little.
  EXPECT_LT(back["frame"], paused["frame"]);
  EXPECT_GT(back["frame"], paused["frame"].get<int>() - 20);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// Kilometers away from zero: shown about an origin of its own, moved and kept where it stands.
TEST_F(Window, AFarSceneIsPlayedAsOneNearby) {
  folder.write("far.json", R"({"weft": 1, "cloths": [{"grid": {"points": [20, 20],
      "origin": [4000, 500, -7000]}, "pins": [[0, 0], [19, 0]]}],
      "colliders": [{"sphere": {"center": [4000.5, 499.5, -6999.5], "radius": 0.2}}]})");
  Screen screen(folder);
  screen.open("far.json --paused");
  const Json before = screen.now();
  EXPECT_EQ(before["bodies"][0], (Json{4000.5, 499.5, -6999.5}));
  screen.key("space");
  screen.wait_for("paused", false);
  screen.type("keydown Right sleep 1 keyup Right");
  screen.wait("the sphere to move and stay", [&](const Json& now) {
    return now["edited"] == true && now["bodies"][0] != before["bodies"][0];
  });
  screen.key("5");
  screen.wait_for("tool", "ball");
  screen.click(760, 300);
  const Json shot = screen.wait(
      "a ball", [&](const Json& now) { return now["bodies"].size() == 2 && now["frame"] > 20; });
  const double centers[] = {4000, 500, -7000};
  for (const Json& body : shot["bodies"])
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(body[k], centers[k], 20);
  screen.key("ctrl+s");
  screen.wait("the saved scene", [](const Json& now) { return now["edited"] == false; });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  EXPECT_EQ(weft("check far.json"), 0);
  const Json saved = Json::parse(folder.read("far.json"));
  EXPECT_NEAR(saved["colliders"][0]["sphere"]["center"][1], 499.5, 0.1);
  EXPECT_NE(saved["colliders"][0]["sphere"]["center"][0], 4000.5);
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
