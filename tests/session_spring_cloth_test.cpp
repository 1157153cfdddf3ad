// Seed 000's parameters by its names: read from its scenes, and put back into them.
#include <gtest/gtest.h>

#include <algorithm>

#include "edit/spring_cloth.h"
#include "scene/document.h"

namespace weft::viewer {
namespace {

Scene scene_of(int number, const char* kind) {
  return read_scene("seed" + std::to_string(number) + "_" + kind).scene;
}

// Of every scene of the seed: the values that it prints.
TEST(SpringCloth, ReadsWhatTheSeedPrints) {
  for (int number : {1, 2, 3})
    for (const auto& [kind, k, iterations] :
         {std::tuple{"positional", 0.5, 10}, {"spring", 15.0, 10}, {"friction", 10.0, 5}}) {
      const Scene scene = scene_of(number, kind);
      ASSERT_TRUE(is_spring_cloth(scene)) << kind;
      const SpringCloth s = spring_cloth_of(scene);
      EXPECT_EQ(s.cloth_dim, 30);
      EXPECT_NEAR(s.particle_offset, 0.15, 1e-12);
      EXPECT_EQ(s.particle_mass, 0.1);
      EXPECT_EQ(s.k, k) << kind;
      EXPECT_EQ(s.constraint_iterations, iterations) << kind;
      EXPECT_EQ(s.constraint_level, 2);
      EXPECT_NEAR(s.offset_multiplier, 1.15, 1e-9);
      EXPECT_EQ(s.cut_length > 1, number == 3);
      EXPECT_EQ(with(scene, s), scene);
      EXPECT_TRUE(changes_to(scene, s).empty());
    }
  EXPECT_FALSE(is_spring_cloth(read_scene("swing").scene));
}

// Each parameter, several at once and back: what was asked for is what is read, and validates.
TEST(SpringCloth, PutsEveryParameterIntoTheScene) {
  for (int number : {1, 2, 3})
    for (const Method type : {Method::positional, Method::spring, Method::spring_friction}) {
      Scene scene = scene_of(number, "spring");
      SpringCloth wanted = spring_cloth_of(scene);
      wanted.type = type;
      scene = with(scene, wanted);
      wanted = {47,  0.1, 0.25, -4, type, type == Method::positional ? 0.3 : 12,
                0.2, 7,   3,    2,  1.3,  4};
      const Scene changed = with(scene, wanted);
      EXPECT_TRUE(validate(changed).empty()) << number << int(type);
      const SpringCloth now = spring_cloth_of(changed);
      EXPECT_EQ(now.cloth_dim, 47);
      EXPECT_NEAR(now.particle_offset, 0.1, 1e-12);
      EXPECT_NEAR(now.offset_multiplier, 1.3, 1e-12);
      EXPECT_EQ(now.k, wanted.k);
      EXPECT_EQ(now.u, 0.2);
      EXPECT_EQ(now.type, type);
      EXPECT_EQ(now.gravity, -4);
      EXPECT_EQ(now.particle_mass, 0.25);
      EXPECT_EQ(now.constraint_iterations, 7);
      EXPECT_EQ(now.constraint_level, 3);
      EXPECT_EQ(now.collision_iterations, 2);
      EXPECT_EQ(now.cut_length, 4);
      EXPECT_EQ(changed.solver.iterate_springs, type != Method::positional);
      // The whole upper edge stays held, and moves as it did.
      const Cloth& cloth = changed.cloths[0];
      EXPECT_EQ(cloth.pins.size(), 47u);
      for (const Pin& pin : cloth.pins) {
        EXPECT_EQ(pin.j, 0);
        EXPECT_EQ(pin.keys.size(), scene.cloths[0].pins[0].keys.size());
        for (const Key& key : pin.keys) {
          if (key.time > 1) continue;
          EXPECT_NEAR(key.position[0], cloth.grid.origin[0] + 0.1 * pin.i, 1e-9);
        }
      }
      for (const Document::Change& change : changes_to(scene, wanted))
        EXPECT_EQ(text::document_of(changed)[text::Json::json_pointer(change.pointer)],
                  change.value);
    }
}

TEST(SpringCloth, CornersStayCorners) {
  Scene scene = scene_of(1, "spring");
  scene.cloths[0].pins = {{0, 0, {}},  {1, 0, {}},  {2, 0, {}},
                          {27, 0, {}}, {28, 0, {}}, {29, 0, {}}};
  SpringCloth wanted = spring_cloth_of(scene);
  wanted.cloth_dim = 59;
  const Scene larger = with(scene, wanted);
  EXPECT_EQ(larger.cloths[0].pins.size(), 10u);  // 0 … 4 and 54 … 58
  EXPECT_TRUE(validate(larger).empty());
  wanted.cloth_dim = 5;
  EXPECT_TRUE(validate(with(scene, wanted)).empty());
  wanted.cut_length = 1;
  EXPECT_EQ(with(scene, wanted).cloths[0].tear_strain, 0);
}

}  // namespace
}  // namespace weft::viewer
