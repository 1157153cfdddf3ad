// The key `fabric` of a cloth, which stands for the values of weft/fabric.h.
#include <gtest/gtest.h>

#include <string>

#include "scene/schema.h"
#include "weft/fabric.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

std::string told(const std::vector<Fault>& faults) {
  std::string all;
  for (const Fault& f : faults) all += f.place + ": " + f.what + " (" + f.allowed + ")\n";
  return all;
}

// A scene of one cloth with these keys, and of this solver.
SceneFile read(const std::string& cloth, const std::string& solver = "{}") {
  return read_scene_text(R"({"weft": 1, "solver": )" + solver + R"(, "cloths": [{)" + cloth +
                         "}]}");
}

Cloth cloth_of(const std::string& cloth, const std::string& solver = "{}") {
  const SceneFile file = read(cloth, solver);
  EXPECT_EQ(told(file.faults), "") << cloth;
  return file.scene.cloths.at(0);
}

std::string named(const Fabric& fabric) {
  return "\"fabric\": \"" + std::string(fabric.name) + "\"";
}

TEST(Fabrics, AreThoseThatTheSchemaNames) {
  const text::Json& names = text::scene_schema_json().at(
      text::Json::json_pointer("/properties/cloths/items/properties/fabric/enum"));
  ASSERT_EQ(names.size(), fabrics().size());
  for (std::size_t k = 0; k < names.size(); ++k) {
    EXPECT_EQ(names[k], std::string(fabrics()[k].name));
    EXPECT_EQ(find_fabric(fabrics()[k].name), &fabrics()[k]);
  }
  EXPECT_EQ(find_fabric("Silk"), nullptr);
  EXPECT_EQ(find_fabric(""), nullptr);
}

TEST(Fabrics, StandForTheirValues) {
  for (const Fabric& fabric : fabrics()) {
    const Cloth cloth = cloth_of(named(fabric));
    EXPECT_EQ(cloth.density, fabric.weight) << fabric.name;
    EXPECT_EQ(cloth.membrane, fabric.membrane) << fabric.name;
    EXPECT_EQ(cloth.bending, fabric.bending) << fabric.name;
    EXPECT_EQ(cloth.self_collision.friction, fabric.friction) << fabric.name;
    Cloth made;
    make_of(fabric, Method::spring, made);
    EXPECT_EQ(cloth, made) << fabric.name;
  }
}

// What a cloth had before leaves no trace but what is no matter of a fabric.
TEST(Fabrics, TakeThePlaceOfWhatAClothHad) {
  for (const Method method :
       {Method::positional, Method::spring, Method::spring_friction, Method::compliant})
    for (const Fabric& fabric : fabrics()) {
      Scene scene;
      scene.solver.method = method;
      Cloth& cloth = scene.cloths.emplace_back();
      cloth.masses = {1, 2, 3, 4};
      cloth.particle_mass = 3;
      cloth.level = 1;
      cloth.stiffness = {5, 6, 7};
      cloth.spring_damping = {1, 1, 1};
      cloth.drag = 2;
      make_of(fabric, method, cloth);
      EXPECT_EQ(told(validate(scene)), "") << fabric.name;
      EXPECT_EQ(cloth.drag, 2);
      EXPECT_EQ(cloth.membrane.given(), method != Method::positional);
      EXPECT_NEAR(particle_mass(cloth, 0, 0), fabric.weight / 4, 1e-12);
    }
}

TEST(Fabrics, GiveWayToEveryKeyOfTheCloth) {
  const Fabric& cotton = *find_fabric("cotton");
  const Cloth cloth = cloth_of(R"("fabric": "cotton", "density": 0.3,
      "membrane": {"shear": 20}, "bending": {"twist": 3e-6}, "self_collision": {"thickness": 0.02})");
  EXPECT_EQ(cloth.density, 0.3);
  EXPECT_EQ(cloth.membrane.shear, 20);
  EXPECT_EQ(cloth.membrane.warp, cotton.membrane.warp);
  EXPECT_EQ(cloth.bending.twist, 3e-6);
  EXPECT_EQ(cloth.bending.weft, cotton.bending.weft);
  EXPECT_EQ(cloth.self_collision.thickness, 0.02);
  EXPECT_EQ(cloth.self_collision.friction, cotton.friction);
  EXPECT_EQ(cloth_of(R"("fabric": "cotton", "bending": 0)").bending, Bending(0));

  // Springs of one's own are in place of the membrane.
  const Cloth springs = cloth_of(R"("fabric": "cotton", "stiffness": {"structural": 50})");
  EXPECT_FALSE(springs.membrane.given());
  EXPECT_EQ(springs.stiffness.structural, 50);
  EXPECT_EQ(springs.density, cotton.weight);

  // No membranes with positional.
  const Cloth positional = cloth_of(named(cotton), R"({"method": "positional"})");
  EXPECT_FALSE(positional.membrane.given());
  EXPECT_EQ(positional.stiffness.shear, cotton.membrane.shear);
  EXPECT_EQ(positional.stiffness.bend, 0);
}

TEST(Fabrics, AreOverriddenAndWritten) {
  const SceneFile silk = read_scene("cusick", {{"/cloths/0/fabric", "silk"}});
  EXPECT_EQ(told(silk.faults), "");
  EXPECT_EQ(silk.scene.cloths[0].membrane, find_fabric("silk")->membrane);
  EXPECT_EQ(silk.scene.cloths[0].bending, find_fabric("silk")->bending);
  const SceneFile again = read_scene_text(write_scene_text(silk.scene));
  EXPECT_EQ(told(again.faults), "");
  EXPECT_EQ(again.scene.cloths[0].membrane, silk.scene.cloths[0].membrane);
  EXPECT_EQ(again.scene.cloths[0].bending, silk.scene.cloths[0].bending);
}

TEST(Fabrics, AreFaultedWhereTheySayNothing) {
  const std::string known = " (silk, cotton, wool, denim or leather)\n";
  EXPECT_EQ(told(read(R"("fabric": "tweed")").faults),
            "/cloths/0/fabric: fabric is \"tweed\"" + known);
  EXPECT_NE(told(read(R"("fabric": 3)").faults).find("/cloths/0/fabric"), std::string::npos);
  EXPECT_NE(told(read(R"("fabric": ["silk"])").faults).find("/cloths/0/fabric"), std::string::npos);
  // All that it stands for is given: as of a course scene, whose values are all given.
  const std::string nothing =
      "/cloths/0/fabric: the fabric gives nothing: density, membrane or springs, bending and "
      "friction are given (one of them left out, or no fabric)\n";
  EXPECT_EQ(told(read(R"("fabric": "silk", "density": 1, "stiffness": {}, "bending": 0,
      "self_collision": {"friction": 0})")
                     .faults),
            nothing);
  EXPECT_EQ(told(read_scene("pinned2", {{"/cloths/0/fabric", "silk"}}).faults), nothing);
  // Broken scenes around a fabric stay what they are.
  for (const char* text : {R"({"weft": 1, "cloths": 3})", R"({"weft": 1, "cloths": [3]})",
                           R"({"weft": 1, "cloths": [{"fabric": "silk", "membrane": 3}]})",
                           R"({"weft": 1, "cloths": [{"fabric": "silk", "self_collision": []}]})",
                           R"({"weft": 1, "solver": 3, "cloths": [{"fabric": "silk"}]})"})
    EXPECT_FALSE(read_scene_text(text).faults.empty()) << text;
}

}  // namespace
}  // namespace weft
