// glTF files, read back by what the format says, and pairs of a .gltf and its buffer.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "folder.h"
#include "made_up_cloth.h"

namespace weft {
namespace {

// What a reader of the format sees: the JSON, and a float of an accessor.
struct Model {
  nlohmann::json json;
  std::string buffer;
  float value(std::size_t accessor, std::size_t number) const {
    const auto view =
        json["bufferViews"][json["accessors"][accessor]["bufferView"].get<std::size_t>()];
    EXPECT_LT(number * 4, view["byteLength"].get<std::size_t>());
    return value_at<float>(buffer, view["byteOffset"].get<std::size_t>() + number * 4);
  }
};

Model read_glb(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 4), 2U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 8), bytes.size());
  const auto text = value_at<std::uint32_t>(bytes, 12);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  EXPECT_EQ(text % 4, 0U);
  const auto size = value_at<std::uint32_t>(bytes, 20 + text);
  EXPECT_EQ(bytes.substr(24 + text, 4), std::string("BIN\0", 4));
  EXPECT_EQ(28 + text + size, bytes.size());
  return {nlohmann::json::parse(bytes.substr(20, text)), bytes.substr(28 + text)};
}

void expect_two_sheets(const Model& model) {
  const auto& mesh = model.json["meshes"][1];
  const auto& primitive = mesh["primitives"][0];
  ASSERT_EQ(primitive["targets"].size(), 2U);  // all samples but the first
  const auto accessor = [&](const nlohmann::json& holder) {
    return holder["POSITION"].get<std::size_t>();
  };
  EXPECT_EQ(model.value(accessor(primitive["attributes"]), 1), 1.0F / 3.0F);
  EXPECT_EQ(model.value(accessor(primitive["attributes"]), 3), 0.1F);
  EXPECT_EQ(model.value(accessor(primitive["targets"][0]), 0), 5.0F);
  EXPECT_EQ(model.value(accessor(primitive["targets"][1]), 3), 7.0F);
  EXPECT_EQ(model.json["accessors"][accessor(primitive["targets"][0])]["max"][0], 5.0);
  EXPECT_EQ(model.json["accessors"][primitive["indices"].get<std::size_t>()]["count"], 6);
  const auto& animation = model.json["animations"][0];
  EXPECT_EQ(animation["channels"].size(), 2U);
  const auto input = animation["samplers"][0]["input"].get<std::size_t>();
  const auto output = animation["samplers"][0]["output"].get<std::size_t>();
  EXPECT_EQ(model.value(input, 1), 0.25F);
  for (std::size_t sample = 0; sample < 3; ++sample)
    for (std::size_t target = 0; target < 2; ++target)
      EXPECT_EQ(model.value(output, sample * 2 + target), sample == target + 1 ? 1.0F : 0.0F);
  EXPECT_EQ(model.json["buffers"][0]["byteLength"], model.buffer.size());
}

void append_two_sheets(Animation& animation, Sheet& one, Sheet& two) {
  View view = view_of({&one, &two});
  animation.append(view);
  two.move(5);
  view.time = 0.25;
  animation.append(view);
  two.move(7);
  view.time = 0.5;
  animation.append(view);
  animation.finish();
}

TEST(Gltf, HasAMorphTargetForEverySample) {
  const Folder folder;
  Sheet one(3, 2), two(2, 2);
  const auto glb = open_animation(folder / "a.glb", view_of({&one, &two}), 3);
  append_two_sheets(*glb, one, two);
  expect_two_sheets(read_glb(folder.read("a.glb")));
  EXPECT_EQ(folder.files(), 1U);
  two.move(0);
  const auto gltf = open_animation(folder / "b.gltf", view_of({&one, &two}), 3);
  append_two_sheets(*gltf, one, two);
  const Model model{nlohmann::json::parse(folder.read("b.gltf")), folder.read("b.bin")};
  EXPECT_EQ(model.json["buffers"][0]["uri"], "b.bin");
  expect_two_sheets(model);
}

// What a .gltf and its .bin say of themselves, read as a program reads them: one run's positions all
// the way, however its steps were cut short.
void expect_pair(const Folder& folder, float first) {
  const auto json = nlohmann::json::parse(folder.read("a.gltf"));
  const std::string uri = json["buffers"][0]["uri"];
  const Model model{json, folder.read(uri)};
  ASSERT_EQ(json["buffers"][0]["byteLength"], model.buffer.size()) << uri;
  EXPECT_EQ(model.value(1, 0), first) << uri;
  EXPECT_EQ(json["accessors"][1]["min"][0], first) << uri;
}

void export_pair(const Folder& folder, float offset) {
  Sheet sheet(3, 2);
  sheet.move(offset);
  const auto animation = open_animation(folder / "a.gltf", view_of({&sheet}));
  animation->append(view_of({&sheet}));
  animation->finish();
}

TEST(Gltf, ReplacesAPair) {
  const Folder folder;
  for (const float offset : {1.0F, 2.0F, 3.0F}) {
    export_pair(folder, offset);
    expect_pair(folder, offset);
    EXPECT_TRUE(folder.has("a.bin"));
    EXPECT_EQ(folder.files(), 2U);
  }
}

// After each of the steps from one pair to the next a process may be gone.
TEST(Gltf, GoesOnFromWhereAKilledExportStopped) {
  const Folder folder;
  export_pair(folder, 1);
  const std::string old_json = folder.read("a.gltf"), old_buffer = folder.read("a.bin");
  export_pair(folder, 2);
  const std::string json = folder.read("a.gltf"), buffer = folder.read("a.bin");
  std::string passing = json;
  passing.replace(passing.find("a.bin"), 5, "a.weft-new.bin");
  const std::array<std::array<std::string, 3>, 4> steps{{{old_json, old_buffer, buffer},
                                                         {passing, old_buffer, buffer},
                                                         {passing, buffer, buffer},
                                                         {json, buffer, buffer}}};
  for (std::size_t n = 0; n < steps.size(); ++n) {
    folder.write("a.gltf", steps[n][0]);
    folder.write("a.bin", steps[n][1]);
    folder.write("a.weft-new.bin", steps[n][2]);
    expect_pair(folder, n == 0 ? 1.0F : 2.0F);
    export_pair(folder, 3);
    expect_pair(folder, 3);
    EXPECT_EQ(folder.files(), 2U) << n;
  }
}

TEST(Gltf, WritesAnyNameOfABufferAsAUri) {
  const Folder folder;
  const Sheet sheet(3, 2);
  const auto animation = open_animation(folder / "a b\xff.gltf", view_of({&sheet}));
  animation->append(view_of({&sheet}));
  animation->finish();
  const auto json = nlohmann::json::parse(folder.read("a b\xff.gltf"));
  EXPECT_EQ(json["buffers"][0]["uri"], "a%20b%FF.bin");
  EXPECT_TRUE(folder.has("a b\xff.bin"));
}

TEST(Gltf, IsOneFileWithAnyCaseOfItsExtension) {
  const Folder folder;
  const Sheet sheet(3, 2);
  const auto animation = open_animation(folder / "a.GLB", view_of({&sheet}));
  animation->append(view_of({&sheet}));
  animation->finish();
  EXPECT_EQ(folder.read("a.GLB").substr(0, 4), "glTF");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(Gltf, RefusesWhatDoesNotFit) {
  const Folder folder;
  const Sheet sheet(3, 2);
  EXPECT_THROW(open_animation(folder / "a.glb", view_of({&sheet}), 5000), WriteError);
  View large = view_of({&sheet});
  large.cloths[0].columns = large.cloths[0].rows = 1000;
  EXPECT_THROW(open_animation(folder / "a.glb", large, 1000), WriteError);
  const auto animation = open_animation(folder / "a.glb", view_of({&sheet}), 3);
  View torn = view_of({&sheet});
  torn.cloths[0].topology_version = 1;
  EXPECT_THROW(animation->append(torn), WriteError);
}

}  // namespace
}  // namespace weft
