// The panel and the schema of scenes, compared key by key; forms of values, and lists as text.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "screen.h"

namespace weft {
namespace {

using nlohmann::json;

json schema() {
  std::ifstream file(std::string(WEFT_SOURCE_DIR) + "/docs/scene.schema.json");
  return json::parse(file);
}

// The schema in the place of a reference to it.
json resolved(const json& part, const json& whole) {
  if (!part.contains("$ref")) return part;
  const auto name = part["$ref"].get<std::string>().substr(1);
  json found = resolved(whole.at(json::json_pointer(name)), whole);
  found.update(part);
  return found;
}

// Places of all values that have no members, but for those of lists that have controls as a whole. `scene` says
// how many cloths and colliders there are, and of which shape.
void add_places(const json& part, const json& whole, const json& value, const std::string& place,
                std::set<std::string>& places) {
  const json here = resolved(part, whole);
  if (here.contains("const")) return;
  if (here.contains("properties")) {
    for (const auto& [key, property] : here["properties"].items()) {
      const bool shape =
          here.contains("oneOf") && resolved(property, whole).value("type", "") == "object";
      if (shape && !value.contains(key)) continue;  // of another collider
      add_places(property, whole, value.is_object() ? value.value(key, json()) : json(),
                 place + "/" + key, places);
    }
  } else if (place == "/cloths" || place == "/colliders") {
    for (std::size_t k = 0; k < value.size(); ++k)
      add_places(here["items"], whole, value[k], place + "/" + std::to_string(k), places);
  } else {
    places.insert(place);
  }
}

// Every key of a scene has a control, which a search for its place shows; the key fabric has the fabrics' buttons.
TEST_F(Window, ThePanelHasAControlForEveryKeyOfTheSchema) {
  const json scene = json::parse(R"({"weft": 1,
      "cloths": [{"grid": {"points": [8, 8]}, "cuts": [[[-1, 3.5], [4, 3.5]]],
                  "pins": [[0, 0], {"vertices": [5, 6]}, {"box": [[0.9, 0, 0.9], [1, 0, 1]]}]}],
      "colliders": [{"sphere": {}}, {"plane": {"point": [0, -3, 0]}}, {"capsule": {}}, {"box": {}},
                    {"cylinder": {}}, {"tapered_capsule": {}}]})");
  folder.write("all.json", scene.dump());
  std::set<std::string> places;
  const json whole = schema();
  add_places(whole, whole, scene, "", places);
  ASSERT_GT(places.size(), 100u);
  Screen screen(folder, 660, 5400);
  screen.open("all.json --paused --quality quick");
  json controls = screen.now()["controls"];
  for (const char* fabric : {"silk", "cotton", "wool", "denim", "leather"})
    EXPECT_TRUE(controls.contains(fabric)) << fabric;
  screen.click("filter");
  screen.type("type /");
  controls = screen.wait("all groups", [](const json& now) {
    return now["controls"].contains("/colliders/5/tapered_capsule/radius_b");
  })["controls"];
  screen.key("Return");  // leaves the filter
  screen.wait_for("typing", false);
  for (const std::string& place : places)
    EXPECT_TRUE(controls.contains(place) || place == "/cloths/0/fabric") << place;
  // Of pins, too, whatever holds them.
  for (const char* place :
       {"/cloths/0/pins/0/keys", "/cloths/0/pins/0/rotate", "/cloths/0/pins/0/follow",
        "/cloths/0/pins/1/vertices", "/cloths/0/pins/1/keys", "/cloths/0/pins/2/box/0",
        "/cloths/0/pins/2/box/1", "/cloths/0/pins text", "/cloths/0/cuts remove 0"})
    EXPECT_TRUE(controls.contains(place)) << place;
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// Types text into a control that is left of its name, in place of what is there, and takes it with Enter.
void enter(const Screen& screen, const std::string& control, const std::string& text) {
  screen.click(control);
  screen.wait_for("typing", true);
  screen.type("key ctrl+a type --delay 20 '" + text + "'");
  screen.key("Return");
  screen.wait_for("typing", false);
}

// A number becomes one for each direction, a vector its keys, and a list is typed; wrong text is refused.
TEST_F(Window, ValuesHaveOtherFormsAndListsAreTyped) {
  folder.write("sheet.json", R"({"weft": 1, "gravity": [0, -2, 0], "cloths": [{"grid":
      {"points": [8, 8]}, "bending": 1e-5}], "colliders": [{"sphere": {"center": [0, -3, 0]},
      "friction": 0.5}]})");
  Screen screen(folder);
  screen.open("sheet.json --paused --quality quick");
  const auto show = [&](const std::string& place) {
    screen.click("filter");
    screen.type("key ctrl+a type --delay 20 " + place);
    screen.key("Return");
    screen.wait_for("typing", false);
  };
  const auto become = [&](const std::string& place, const std::string& form,
                          const std::string& then) {
    show(place);
    screen.click(place + " form");
    screen.click(place + " " + form);
    screen.wait(then, [&](const json& now) { return now["controls"].contains(then); });
  };
  become("/cloths/0/bending", "warp, weft, twist, damping", "/cloths/0/bending/twist");
  become("/colliders/0/friction", "static, dynamic, damping, bias", "/colliders/0/friction/bias");
  become("/gravity", "over time", "/gravity/keys");
  show("/colliders/0/color");
  enter(screen, "/colliders/0/color", "#20c040");
  EXPECT_EQ(screen.now()["undo"], "sphere color");
  show("/cloths/0/color");
  enter(screen, "/cloths/0/color/back", "#0a0B0c");
  EXPECT_TRUE(screen.now()["controls"].contains("/cloths/0/color/front swatch"));
  EXPECT_TRUE(screen.now()["news"].empty()) << screen.now()["news"];
  enter(screen, "/cloths/0/color/front", "green");
  screen.wait("its fault", [](const json& now) {
    return now["news"].dump().find("rrggbb") != std::string::npos;
  });
  EXPECT_EQ(screen.now()["undo"], "cloth color back");
  show("/cloths/0/pins");
  enter(screen, "/cloths/0/pins text", "[[0, 0], {\"vertices\": [5, 6]}]");
  screen.wait_for("held", 3);
  enter(screen, "/cloths/0/pins text", "[[0, 0], {\"vertices\": [5, 99]}]");
  screen.wait("a message",
              [](const json& now) { return now["news"].dump().find("99") != std::string::npos; });
  EXPECT_EQ(screen.now()["held"], 3);
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  EXPECT_EQ(weft("check sheet.json"), 0) << folder.read("weft.out");
  const json saved = json::parse(folder.read("sheet.json"));
  EXPECT_EQ(saved["gravity"], json::parse(R"({"keys": [[0, 0, -2, 0]]})"));
  EXPECT_EQ(saved["cloths"][0]["bending"], 1e-5) << "alike in all directions";
  EXPECT_EQ(saved["colliders"][0]["friction"], 0.5);
  EXPECT_EQ(saved["colliders"][0]["color"], "#20c040");
  EXPECT_EQ(saved["cloths"][0]["color"], json::parse(R"({"back": "#0a0B0c"})"));
  EXPECT_EQ(saved["cloths"][0]["pins"].size(), 2u);
}

// A course scene has the course's parameters by its names, which the search finds.
TEST_F(Window, CourseParametersAreFoundByTheirNames) {
  Screen screen(folder);
  screen.open("pinned2 --paused");
  const auto find = [&](const std::string& word, const std::string& control) {
    screen.click("filter");
    screen.wait_for("typing", true);
    screen.type("key ctrl+a type --delay 20 " + word);
    screen.key("Return");
    screen.wait(control, [&](const json& now) {
      return now["controls"].contains(control) && !now["controls"].contains("silk");
    });
  };
  find("ks", "ks [N/m]");
  EXPECT_FALSE(screen.now()["controls"].contains("damping [%]"));
  screen.type_number("ks [N/m]", "800");
  screen.wait_for("stiffness", 800);
  EXPECT_EQ(screen.now()["undo"], "ks");
  find("density", "density [g/cm²]");
  screen.type_number("density [g/cm²]", "1.5");
  find("damping", "damping [%]");
  screen.type_number("damping [%]", "0.9");
  find("gravity", "gravity [m/s²]");
  screen.type_number("gravity [m/s²]", "-3");
  find("bending", "bending springs");
  screen.click("bending springs");
  EXPECT_TRUE(screen.now()["news"].empty()) << screen.now()["news"];
  screen.key("ctrl+s");
  screen.wait_for("edited", false);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  const json saved = json::parse(folder.read("pinned2-edited.json"));
  const json& cloth = saved["cloths"][0];
  EXPECT_EQ(cloth["stiffness"], json::parse(R"({"structural": 800, "shear": 800, "bend": 0})"));
  EXPECT_NEAR(cloth["particle_mass"].get<double>(), 15 / 2500.0, 1e-12);
  EXPECT_NEAR(cloth["drag"].get<double>(), 0.9 * 27, 1e-10);
  EXPECT_EQ(saved["gravity"], json::parse("[0, -3, 0]"));
}

}  // namespace
}  // namespace weft
