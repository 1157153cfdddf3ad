// A hand on cloth that does not move: what is dragged in a paused scene.
#include "screen.h"

namespace weft {
namespace {

using Json = nlohmann::json;

constexpr const char* kSheet = R"({"weft": 1, "camera": {"azimuth": 0, "elevation": 0},
    "cloths": [{"grid": {"points": [16, 16], "origin": [-0.5, 0, 0], "u": [1, 0, 0], "v": [0, -1, 0]},
                "pins": [[0, 0], [15, 0]]}]})";

// White of the hand's mark about a control.
double white_at(const std::string& rgb, const Json& at) {
  double white = 0, all = 0;
  for (int y = -3; y <= 3; ++y)
    for (int x = -3; x <= 3; ++x, ++all) {
      const auto p = static_cast<std::size_t>(
          3 * (Screen::kWidth * (at[1].get<int>() + y) + at[0].get<int>() + x));
      white +=
          static_cast<unsigned char>(rgb[p]) > 210 && static_cast<unsigned char>(rgb[p + 1]) > 200;
    }
  return white / all;
}

// The hand stays, and is seen; it pulls when the run goes on, and lets go when the point is there.
TEST_F(Window, AHandInAPausedScenePullsWhenItGoesOn) {
  folder.write("sheet.json", kSheet);
  Screen screen(folder);
  screen.open("sheet.json --paused");
  screen.drag({{808, 500}, {860, 540}, {960, 560}}, "the hand",
              [](const Json& now) { return now["controls"].contains("hand"); });
  const Json waiting = screen.wait_for("waiting", true);
  EXPECT_EQ(waiting["frame"], 0);
  EXPECT_NE(waiting["news"].dump().find("goes on"), std::string::npos) << waiting["news"];
  screen.wait_picture("the hand", [&](const std::string& rgb) {
    return white_at(rgb, waiting["controls"]["hand"]) > 0.7;
  });
  const std::string before = screen.picture();
  screen.key("space");
  screen.wait("the pull", [](const Json& now) { return now["frame"] > 2; });
  screen.wait_picture("cloth that was pulled",
                      [&](const std::string& now) { return difference(now, before) > 1; });
  screen.wait_for("waiting", false);

  // A click lets go; so does a new start.
  screen.key("r");
  screen.key("space");
  screen.wait_for("paused", true);
  for (const char* end : {"click 1", "key r"}) {
    screen.drag({{808, 430}, {860, 450}, {960, 480}}, "the hand",
                [](const Json& now) { return now["controls"].contains("hand"); });
    screen.wait_for("waiting", true);
    screen.step_to(screen.now()["frame"].get<int>() + 1);
    screen.type(std::string("mousemove 1250 650 sleep 0.4 ") + end);
    screen.wait_for("waiting", false);
  }
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

}  // namespace
}  // namespace weft
