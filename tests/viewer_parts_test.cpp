// Cloths and bodies added, turned, sized, copied and taken away in the window, undone and saved.
#include "screen.h"

namespace weft {
namespace {

using Json = nlohmann::json;

constexpr const char* kSheet = R"({"weft": 1, "camera": {"azimuth": 0, "elevation": 0},
    "cloths": [{"grid": {"points": [12, 12], "origin": [-0.5, 0, 0], "u": [1, 0, 0], "v": [0, -1, 0]},
                "pins": [[0, 0], {"at": [11, 0], "keys": [[0, 0.5, 0, 0]]}]}]})";
constexpr int kX = 808, kY = 400;  // where the camera looks

void wait_for_undo(const Screen& screen, const std::string& name) {
  screen.wait(name, [&](const Json& now) { return now["undo"] == name; });
}

void wait_for_bodies(const Screen& screen, std::size_t count) {
  screen.wait(std::to_string(count) + " bodies",
              [&](const Json& now) { return now["bodies"].size() == count; });
}

// Filters the panel by a word until it shows a control, and all of the word is typed.
void look_for(const Screen& screen, const std::string& word, const std::string& control) {
  screen.click("filter");
  screen.type("key ctrl+a type " + word);
  screen.key("Return");
  screen.wait(control, [&](const Json& now) {
    return now["controls"].contains(control) && now["typing"] == false;
  });
}

// By the rings and the square of the gizmo, seen along z.
TEST_F(Window, BodiesAreAddedTurnedSizedCopiedAndTakenAway) {
  folder.write("sheet.json", kSheet);
  Screen screen(folder);
  screen.open("sheet.json --paused");
  screen.click("add box");
  wait_for_bodies(screen, 1);
  screen.wait_for("tool", "move");
  wait_for_undo(screen, "add box");
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  const Json added = Json::parse(folder.read("sheet.json"))["colliders"][0]["box"];

  const auto undo_is = [](const std::string& name) {
    return [name](const Json& now) { return now["undo"] == name; };
  };
  screen.drag({{kX + 48, kY - 48}, {kX + 72, kY - 72}, {kX + 96, kY - 96}}, "a size",
              undo_is("size box"));
  screen.drag({{kX + 76, kY - 76}, {kX + 54, kY - 94}, {kX + 28, kY - 104}}, "a turn",
              undo_is("turn box"));
  screen.drag({{kX + 60, kY}, {kX + 100, kY}, {kX + 120, kY}}, "a move",
              [](const Json& now) { return now["busy"] == true; });
  wait_for_undo(screen, "move box");
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  const Json saved = Json::parse(folder.read("sheet.json"))["colliders"][0]["box"];
  EXPECT_GT(saved["center"][0], added["center"][0].get<double>() + 0.05);
  EXPECT_EQ(saved["center"][1], added["center"][1]);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(saved["half"][k].get<double>() / added["half"][k].get<double>(), 2, 0.1);
  EXPECT_NEAR(saved["rotation"][0], 0, 1e-6);
  EXPECT_NEAR(saved["rotation"][1], 0, 1e-6);
  EXPECT_NEAR(saved["rotation"][2], 30, 2);
  EXPECT_EQ(weft("check sheet.json"), 0) << folder.read("weft.out");

  screen.key("ctrl+d");
  wait_for_bodies(screen, 2);
  screen.key("Delete");
  wait_for_bodies(screen, 1);
  wait_for_undo(screen, "delete");
  screen.key("ctrl+z");
  wait_for_bodies(screen, 2);
  EXPECT_GT(std::abs(screen.now()["bodies"][1][0].get<double>() -
                     screen.now()["bodies"][0][0].get<double>()),
            0.1);
  for (const char* shape : {"sphere", "plane", "capsule", "cylinder", "tapered_capsule"}) {
    const std::size_t count = screen.now()["bodies"].size();
    screen.click(std::string("add ") + shape);
    wait_for_bodies(screen, count + 1);
  }
  screen.key("space");
  screen.wait("frames", [](const Json& now) { return now["frame"] > 10; });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// A cloth is added and one is copied with its pins, each taken away again; what follows a body that goes stays.
TEST_F(Window, ClothsAreAddedCopiedAndTakenAway) {
  folder.write("sheet.json", kSheet);
  Screen screen(folder);
  screen.open("sheet.json");
  screen.wait("frames", [](const Json& now) { return now["frame"] > 5; });
  screen.click("add cloth");
  screen.wait_for("cloths", 2);
  look_for(screen, "jitter", "/cloths/1 delete");
  screen.click("/cloths/0 duplicate");
  screen.wait_for("cloths", 3);
  screen.wait_for("held", 4);
  screen.wait("three of them",
              [](const Json& now) { return now["controls"].contains("/cloths/2 delete"); });
  screen.click("/cloths/1 delete");
  screen.wait_for("cloths", 2);
  screen.wait_for("held", 4);
  screen.wait("frames anew", [](const Json& now) { return now["frame"] > 5; });
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  EXPECT_EQ(weft("run sheet.json --frames 5"), 0) << folder.read("weft.out");
  const Json cloths = Json::parse(folder.read("sheet.json"))["cloths"];
  ASSERT_EQ(cloths.size(), 2u);
  const double aside = cloths[1]["grid"]["origin"][0].get<double>() + 0.5;
  EXPECT_NEAR(aside, 1.15, 1e-9);
  EXPECT_NEAR(cloths[1]["pins"][1]["keys"][0][1].get<double>() - 0.5, aside, 1e-9);
  screen.key("ctrl+z");
  screen.wait_for("cloths", 3);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// Sheets by the same handles as bodies: where they start, so that a run starts anew.
TEST_F(Window, ClothsAreMovedTurnedAndSizedByTheHandles) {
  folder.write("sheet.json", kSheet);
  Screen screen(folder);
  screen.open("sheet.json --paused");
  screen.step_to(2);
  screen.key("4");
  screen.type("mousemove 808 340 sleep 0.5 click 1 sleep 0.5");
  const std::string before = screen.picture();
  const auto pull = [&](std::array<int, 2> from, std::array<int, 2> to, const std::string& name) {
    const Json at = screen.wait("handles", [](const Json& now) {
      return now["controls"].contains("handles");
    })["controls"]["handles"];
    const int x = at[0], y = at[1];
    screen.drag({{x + from[0], y + from[1]},
                 {x + (from[0] + to[0]) / 2, y + (from[1] + to[1]) / 2},
                 {x + to[0], y + to[1]}},
                name, [&](const Json& now) { return now["undo"] == name; });
  };
  pull({60, 0}, {110, 0}, "move cloth");
  screen.wait_for("frame", 0);
  screen.wait_picture("another place",
                      [&](const std::string& now) { return difference(now, before) > 1; });
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  const Json moved = Json::parse(folder.read("sheet.json"))["cloths"][0];
  const double by = moved["grid"]["origin"][0].get<double>() + 0.5;
  EXPECT_GT(by, 0.05);
  EXPECT_NEAR(moved["grid"]["origin"][1], 0, 1e-6);
  EXPECT_NEAR(moved["pins"][1]["keys"][0][1], 0.5 + by, 1e-6);

  pull({48, -48}, {72, -72}, "size cloth");
  pull({76, -76}, {28, -104}, "turn cloth");
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  const Json grid = Json::parse(folder.read("sheet.json"))["cloths"][0]["grid"];
  const double ux = grid["u"][0], uy = grid["u"][1];
  EXPECT_NEAR(std::hypot(ux, uy), 1.5, 0.1);
  EXPECT_NEAR(std::atan2(uy, ux) * 180 / 3.14159265, 30, 3);
  EXPECT_EQ(weft("check sheet.json"), 0) << folder.read("weft.out");

  screen.key("ctrl+d");
  screen.wait_for("cloths", 2);
  screen.key("Delete");
  screen.wait_for("cloths", 1);
  for (const char* left : {"duplicate", "turn cloth", "size cloth", "move cloth", ""}) {
    screen.key("ctrl+z");
    screen.wait_for("undo", left);
  }
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// Pins turn and follow, and a cut is sewn up again, from the panel.
TEST_F(Window, PinsTurnAndFollowAndCutsAreTakenBackInThePanel) {
  folder.write("sheet.json", R"({"weft": 1, "cloths": [{"grid": {"points": [12, 12]},
      "cuts": [[[-1, 5.5], [20, 5.5]], [[5.5, -1], [5.5, 3]]],
      "pins": [[0, 0], [11, 0]]}], "colliders": [{"sphere": {"center": [0, -2, 0], "radius": 0.2}}]})");
  Screen screen(folder);
  screen.open("sheet.json --paused");
  EXPECT_EQ(screen.now()["torn"], true);
  look_for(screen, "pins", "/cloths/0/pins");
  screen.click("/cloths/0/pins");
  screen.click("/cloths/0/pins/1");
  screen.click("/cloths/0/pins/1/rotate");
  screen.click("/cloths/0/pins/1/rotate add");
  screen.wait("an angle", [](const Json& now) {
    return now["controls"].contains("/cloths/0/pins/1/rotate remove 0");
  });
  const Json at = screen.now()["controls"]["/cloths/0/pins/1/follow"];
  screen.type("mousemove 155 " + at[1].dump() + " sleep 0.5 click 1 sleep 0.5");
  look_for(screen, "cuts", "/cloths/0/cuts");
  screen.click("/cloths/0/cuts");
  screen.click("/cloths/0/cuts remove 0");
  screen.wait("one cut",
              [](const Json& now) { return !now["controls"].contains("/cloths/0/cuts remove 1"); });
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  EXPECT_EQ(weft("check sheet.json"), 0) << folder.read("weft.out");
  const Json cloth = Json::parse(folder.read("sheet.json"))["cloths"][0];
  EXPECT_EQ(cloth["cuts"].size(), 1u);
  EXPECT_EQ(cloth["pins"][0], (Json{0, 0}));
  EXPECT_EQ(cloth["pins"][1]["rotate"]["keys"].size(), 1u) << cloth["pins"];
  EXPECT_EQ(cloth["pins"][1]["follow"], 0) << cloth["pins"];
}

}  // namespace
}  // namespace weft
