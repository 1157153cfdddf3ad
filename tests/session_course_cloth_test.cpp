// The course's parameters by its names: put into a scene, they make what the reader of course files makes of a file
// with these values.
#include <gtest/gtest.h>

#include "edit/course_cloth.h"

namespace weft::viewer {
namespace {

// The scene of a course file. `values`: of its cloth, besides its size.
Scene scene_of(const std::string& values) {
  const SceneFile file =
      read_scene_text(R"({"cloth": {"width": 2, "height": 1.5, "num_width_points": 20,
      "num_height_points": 12, "pinned": [[0, 0]])" +
                      values + R"(}, "sphere": {"radius": 0.3}})");
  EXPECT_TRUE(file.faults.empty()) << file.faults[0].what;
  return file.scene;
}

// But for rounding, which goes through an area.
void expect_same(Scene a, const Scene& b, const std::string& values) {
  Cloth& cloth = a.cloths[0];
  const Cloth& wanted = b.cloths[0];
  EXPECT_NEAR(cloth.particle_mass, wanted.particle_mass, 1e-14 * wanted.particle_mass) << values;
  EXPECT_NEAR(cloth.drag, wanted.drag, 1e-13 * wanted.drag) << values;
  cloth.particle_mass = wanted.particle_mass;
  cloth.drag = wanted.drag;
  EXPECT_EQ(a, b) << values;
}

TEST(CourseCloth, IsWhatTheReaderMakesOfItsValues) {
  const Scene plain = scene_of("");
  ASSERT_TRUE(is_course_cloth(plain));
  EXPECT_FALSE(is_course_cloth(read_scene("swing").scene));
  EXPECT_FALSE(is_course_cloth(read_scene("seed1_spring").scene));
  const CourseCloth start = course_cloth_of(plain);
  EXPECT_EQ(start.ks, 5000);
  EXPECT_NEAR(start.density, 15, 1e-12);
  EXPECT_NEAR(start.damping, 0.2, 1e-12);
  EXPECT_EQ(start.gravity, -9.8);
  EXPECT_EQ(start.thickness, 0.0095);
  EXPECT_EQ(with(plain, start), plain) << "nothing else was asked for";
  for (const char* values :
       {R"(, "ks": 500)", R"(, "ks": 50000, "enable_bending": false)", R"(, "density": 15)",
        R"(, "damping": 0.9, "thickness": 0.004)", R"(, "enable_structural": false, "ks": 80)",
        R"(, "enable_structural": false, "enable_shearing": false, "density": 1000)",
        R"(, "ks": 1, "density": 3, "damping": 100, "enable_shearing": false)"}) {
    const Scene wanted = scene_of(values);
    const CourseCloth parameters = course_cloth_of(wanted);
    expect_same(with(plain, parameters), wanted, values);
    expect_same(with(wanted, start), plain, values);
  }
}

// Springs that were all taken away come back with the course's ks; gravity is the scene's; masses become one.
TEST(CourseCloth, PutsBackWhatWasTakenAway) {
  const Scene plain = scene_of("");
  CourseCloth none = course_cloth_of(plain);
  none.structural = none.shearing = none.bending = false;
  const Scene bare = with(plain, none);
  EXPECT_EQ(bare.cloths[0].stiffness, Kinds{});
  CourseCloth again = course_cloth_of(bare);
  EXPECT_EQ(again.ks, 0);
  again.shearing = true;
  EXPECT_EQ(with(bare, again).cloths[0].stiffness, (Kinds{0, 5000, 0}));
  Scene uneven = plain;
  uneven.cloths[0].masses.assign(20 * 12, 0.5);
  CourseCloth other = course_cloth_of(uneven);
  other.gravity = 3;
  EXPECT_EQ(with(uneven, other).gravity, (Vec3{0, 3, 0}));
  EXPECT_EQ(with(uneven, other).cloths[0].masses, uneven.cloths[0].masses);
  other.density = 2;
  EXPECT_TRUE(with(uneven, other).cloths[0].masses.empty());
  EXPECT_NEAR(course_cloth_of(with(uneven, other)).density, 2, 1e-12);
}

}  // namespace
}  // namespace weft::viewer
