// What a person changes in the scene by the window: hands, pins, a lasso, cuts, balls, values of the panel and
// paths; what is undone, made again and saved.
#include <cstring>

#include "screen.h"
#include "weft/fabric.h"

namespace weft {
namespace {

using Json = nlohmann::json;

// An edit that has set a value in the window's state is taken back and made again.
void undo_and_redo(const Screen& screen, const std::string& key, const Json& before,
                   const Json& after) {
  screen.key("ctrl+z");
  screen.wait_for(key, before);
  screen.key("ctrl+y");
  screen.wait_for(key, after);
}

// Filters the panel by a word until it shows a control.
void look_for(const Screen& screen, const std::string& word, const std::string& control) {
  screen.click("filter");
  screen.type("key ctrl+a type " + word);
  screen.wait(control, [&](const Json& now) { return now["controls"].contains(control); });
  screen.key("Return");  // leaves the filter
  screen.wait_for("typing", false);
}

void add_key_to_first_pin(const Screen& screen) {
  look_for(screen, "pins", "/cloths/0/pins");
  screen.click("/cloths/0/pins");
  screen.click("/cloths/0/pins/0");
  screen.click("/cloths/0/pins/0/keys");
  screen.click("/cloths/0/pins/0/keys add");
  screen.wait("a key", [](const Json& now) {
    return now["controls"].contains("/cloths/0/pins/0/keys remove 0");
  });
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
  // Between the corners that hold it and the pin below them the sheet is, however it swings.
  screen.drag({{520, 360}, {700, 365}, {880, 375}, {1060, 380}, {1260, 390}}, "a cut",
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
  undo_and_redo(screen, "torn", false, true);
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
  undo_and_redo(screen, "held", 4, pinned["held"]);
  // All within are pinned: a lasso inside of the first lets go.
  screen.drag({{740, 190}, {900, 200}, {900, 205}, {740, 198}}, "a smaller lasso",
              [](const Json& now) { return now["busy"] == true; });
  screen.wait("fewer pins",
              [&](const Json& now) { return now["held"] < pinned["held"] && now["held"] > 4; });
  EXPECT_EQ(screen.now()["undo"], "unpin");
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// Against gravity: without aim it would pass some 0.3 m below where it was shot at.
TEST_F(Window, ABallMeetsWhatIsClicked) {
  folder.write("sheet.json", R"({"weft": 1, "camera": {"azimuth": 0, "elevation": 0},
      "cloths": [{"grid": {"points": [30, 30], "u": [1, 0, 0], "v": [0, -1, 0]}, "drag": 6,
                  "pins": [[0, 0], [29, 0], [0, 29], [29, 29]]}]})");
  Screen screen(folder);
  screen.open("sheet.json");
  // At rest: a ball meets cloth that moves where that will be.
  screen.wait("the sheet at rest", [](const Json& now) { return now["frame"] > 120; });
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

TEST_F(Window, ChangesAreCheckedUndoneAndSaved) {
  Screen screen(folder);
  screen.open("pinned4 --paused");
  const double start = screen.now()["stiffness"];
  screen.click("denim");
  const Json denim =
      screen.wait("denim", [&](const Json& now) { return now["stiffness"] != start; });
  EXPECT_EQ(denim["edited"], true);
  undo_and_redo(screen, "stiffness", start, denim["stiffness"]);
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  EXPECT_EQ(weft("check pinned4-edited.json"), 0) << folder.read("weft.out");
  const Json saved = Json::parse(folder.read("pinned4-edited.json"))["cloths"][0];
  EXPECT_EQ(saved["density"], find_fabric("denim")->weight);
  EXPECT_EQ(saved["membrane"]["warp"], find_fabric("denim")->membrane.warp);
  EXPECT_FALSE(saved.contains("stiffness")) << saved;

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
  look_for(screen, "keys", "/colliders/0/keys");
  screen.click("/colliders/0/keys");
  screen.click("/colliders/0/keys remove 1");
  screen.wait("two keys", [](const Json& now) {
    return !now["controls"].contains("/colliders/0/keys remove 2");
  });
  screen.click("/colliders/0/keys add");
  screen.wait("a third key again", [](const Json& now) {
    return now["controls"].contains("/colliders/0/keys remove 2");
  });
  add_key_to_first_pin(screen);
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
    return !now["controls"].contains("/cloths/0/pins/0/keys remove 0");
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
  look_for(screen, "wind", "/wind/velocity");
  look_for(screen, "gravity", "/gravity/keys");
  screen.click("/gravity/keys");
  for (const char* remove : {"/gravity/keys remove 1", "/gravity/keys remove 0"})
    screen.click(remove);
  screen.wait("a plain vector",
              [](const Json& now) { return now["controls"].contains("/gravity"); });
  add_key_to_first_pin(screen);
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  const Json saved = Json::parse(folder.read("over.json"));
  EXPECT_EQ(saved["gravity"], Json::parse("[1.0, 0.0, 0.0]"));
  const Json& pin = saved["cloths"][0]["pins"][0];
  EXPECT_EQ(pin["keys"].size(), 1u) << pin;
  EXPECT_EQ(pin["rotate"]["keys"].size(), 2u) << pin;
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

}  // namespace
}  // namespace weft
