// Pins of several particles as the viewer edits them: some let go, stopped on their path, moved with their cloth.
#include <gtest/gtest.h>

#include "edit/cloth_place.h"
#include "edit/document.h"

namespace weft::viewer {
namespace {

using text::Json;

// 5 × 4 particles 0.1 m apart, of which a box holds the last two of the first row.
Cloth sheet() {
  Cloth cloth;
  cloth.grid = {5, 4, {}, {0.4, 0, 0}, {0, 0, 0.3}, 0};
  Pin pin;
  pin.box = BoxCorners{Vec3{0.25, 0, 0}, Vec3{1, 0, 0.05}};
  pin.keys = {{0, {0, 0, 0}}, {1, {0, 0.5, 0}}};
  cloth.pins = {pin};
  return cloth;
}

TEST(Pins, LetSomeGo) {
  const Json box = Json::parse(R"({"box": [[0, 0, 0], [1, 1, 1]], "keys": [[0, 0, 0, 0]]})");
  EXPECT_EQ(remaining_pin_json(box, {3, 4, 7}, {1, 2}), box);
  EXPECT_EQ(remaining_pin_json(box, {3, 4, 7}, {4}),
            Json::parse(R"({"keys": [[0, 0, 0, 0]], "vertices": [3, 7]})"));
  EXPECT_TRUE(remaining_pin_json(box, {3, 4}, {3, 4, 5}).is_null());
  EXPECT_EQ(remaining_pin_json(Json::parse(R"({"group": "hem"})"), {1, 2}, {2}),
            Json::parse(R"({"vertices": [1]})"));
  EXPECT_TRUE(remaining_pin_json(Json::parse("[3, 0]"), {3}, {3}).is_null());
}

TEST(Pins, StandStill) {
  Cloth cloth = sheet();
  EXPECT_EQ(still_pin_json(cloth, cloth.pins[0]), Json::parse(R"({"vertices": [3, 4]})"));
  cloth.pins = {{2, 1, {{0, {0, 0, 0}}}}};
  EXPECT_EQ(still_pin_json(cloth, cloth.pins[0]), Json::parse("[2, 1]"));
}

TEST(Pins, GoWithTheirCloth) {
  const Cloth cloth = sheet();
  const Cloth aside = moved(cloth, {1, 2, 3});
  EXPECT_EQ(held_particles(aside, aside.pins[0]), (std::vector<int>{3, 4}));
  EXPECT_EQ(aside.pins[0].keys, cloth.pins[0].keys);
  const Cloth larger = sized(cloth, 2);
  EXPECT_EQ(held_particles(larger, larger.pins[0]), (std::vector<int>{3, 4}));
  EXPECT_EQ(larger.pins[0].keys[1].position, (Vec3{0, 1, 0}));
  const Cloth aslant = turned(cloth, 1, 0.7);
  EXPECT_EQ(held_particles(aslant, aslant.pins[0]), (std::vector<int>{3, 4}));
}

}  // namespace
}  // namespace weft::viewer
