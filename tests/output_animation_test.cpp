// Point caches and OBJ sequences, read back by what their formats say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "folder.h"
#include "weft/output.h"

namespace weft {
namespace {

// A cloth of made-up positions with padded rows, as the simulation shows them.
class Sheet {
 public:
  Sheet(int columns, int rows) : columns_(columns), rows_(rows) {
    const auto size = static_cast<std::size_t>(rows) * kStride;
    x_.assign(size, kPadding);
    y_ = z_ = x_;
    move(0);
  }
  void move(float offset) {
    for (int j = 0; j < rows_; ++j) {
      for (int i = 0; i < columns_; ++i) {
        const auto n = static_cast<std::size_t>(j) * kStride + static_cast<std::size_t>(i);
        x_[n] = 0.1F * static_cast<float>(i) + offset;
        y_[n] = 1.0F / 3.0F;
        z_[n] = 0.1F * static_cast<float>(j);
      }
    }
  }
  ClothView view() const {
    ClothView view;
    view.columns = columns_;
    view.rows = rows_;
    view.stride = kStride;
    view.x = x_;
    view.y = y_;
    view.z = z_;
    return view;
  }

 private:
  static constexpr int kStride = 16;
  static constexpr float kPadding = 1e30F;  // must never be written
  int columns_, rows_;
  std::vector<float> x_, y_, z_;
};

View view_of(const std::vector<const Sheet*>& sheets) {
  View view;
  for (const Sheet* sheet : sheets) view.cloths.push_back(sheet->view());
  return view;
}

template <class T>
T value_at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST(Pc2, HasTheHeaderThatBlenderReads) {
  const Folder folder;
  const Sheet sheet(3, 2);
  const auto animation = open_animation(folder / "a.pc2", view_of({&sheet}));
  for (int sample = 0; sample < 4; ++sample) animation->append(view_of({&sheet}));
  EXPECT_EQ(folder.has("a.pc2"), false);
  animation->finish();
  EXPECT_EQ(animation->written(), folder / "a.pc2");
  const std::string bytes = folder.read("a.pc2");
  ASSERT_EQ(bytes.size(), 32U + 4 * 6 * 12);
  EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
  EXPECT_EQ(value_at<std::int32_t>(bytes, 12), 1);  // version
  EXPECT_EQ(value_at<std::int32_t>(bytes, 16), 6);  // points
  EXPECT_EQ(value_at<float>(bytes, 20), 0.0F);      // first frame
  EXPECT_EQ(value_at<float>(bytes, 24), 1.0F);      // frames per sample
  EXPECT_EQ(value_at<std::int32_t>(bytes, 28), 4);  // samples
  EXPECT_EQ(folder.files(), 1U);
}

TEST(Pc2, HoldsEveryClothInSceneOrderWithoutPadding) {
  const Folder folder;
  const Sheet one(3, 2);
  Sheet two(2, 2);
  const auto animation = open_animation(folder / "a.PC2", view_of({&one, &two}));
  animation->append(view_of({&one, &two}));
  two.move(5);
  animation->append(view_of({&one, &two}));
  animation->finish();
  const std::string bytes = folder.read("a.PC2");
  const auto position = [&](std::size_t sample, std::size_t point, std::size_t axis) {
    return value_at<float>(bytes, 32 + ((sample * 10 + point) * 3 + axis) * 4);
  };
  ASSERT_EQ(bytes.size(), 32U + 2 * 10 * 12);
  EXPECT_EQ(position(0, 2, 0), 0.2F);  // (2,0) of the first
  EXPECT_EQ(position(0, 3, 2), 0.1F);  // (0,1)
  EXPECT_EQ(position(0, 6, 0), 0.0F);  // (0,0) of the second
  EXPECT_EQ(position(0, 6, 1), 1.0F / 3.0F);
  EXPECT_EQ(position(1, 6, 0), 5.0F);
  EXPECT_EQ(position(1, 0, 0), 0.0F);
}

TEST(Pc2, LeavesNothingWhenTheRunIsGivenUp) {
  const Folder folder;
  const Sheet sheet(3, 2);
  {
    const auto animation = open_animation(folder / "a.pc2", view_of({&sheet}));
    animation->append(view_of({&sheet}));
  }
  EXPECT_EQ(folder.files(), 0U);
}

TEST(Pc2, RefusesAnotherNumberOfParticles) {
  const Folder folder;
  const Sheet sheet(3, 2);
  const Sheet other(3, 3);
  const auto animation = open_animation(folder / "a.pc2", view_of({&sheet}));
  EXPECT_THROW(animation->append(view_of({&other})), std::invalid_argument);
}

template <class T>
T big_endian_at(const std::string& bytes, std::size_t offset) {
  std::string turned = bytes.substr(offset, sizeof(T));
  std::ranges::reverse(turned);
  return value_at<T>(turned, 0);
}

TEST(Mdd, HasTimesThenPositionsOfEverySample) {
  const Folder folder;
  Sheet one(3, 2), two(2, 2);
  const auto animation = open_animation(folder / "a.mdd", view_of({&one, &two}));
  View view = view_of({&one, &two});
  animation->append(view);
  two.move(5);
  view.time = 0.25;
  animation->append(view);
  animation->finish();
  const std::string bytes = folder.read("a.mdd");
  ASSERT_EQ(bytes.size(), 8U + 2 * 4 + 2 * 10 * 12);
  EXPECT_EQ(big_endian_at<std::int32_t>(bytes, 0), 2);
  EXPECT_EQ(big_endian_at<std::int32_t>(bytes, 4), 10);
  EXPECT_EQ(big_endian_at<float>(bytes, 8), 0.0F);
  EXPECT_EQ(big_endian_at<float>(bytes, 12), 0.25F);
  const auto position = [&](std::size_t sample, std::size_t point, std::size_t axis) {
    return big_endian_at<float>(bytes, 16 + ((sample * 10 + point) * 3 + axis) * 4);
  };
  EXPECT_EQ(position(0, 2, 0), 0.2F);
  EXPECT_EQ(position(0, 3, 2), 0.1F);
  EXPECT_EQ(position(0, 6, 1), 1.0F / 3.0F);
  EXPECT_EQ(position(1, 6, 0), 5.0F);
  EXPECT_EQ(folder.files(), 1U);
}

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

// A sheet of two squares that has lost the left one's lower triangle to a tear.
TEST(Obj, ShowsWhatIsLeftOfTornCloth) {
  const Folder folder;
  const Sheet one(3, 2), two(2, 2);
  View view = view_of({&one, &two});
  const std::vector<std::array<std::uint32_t, 3>> left{{0, 1, 16}, {1, 2, 17}, {2, 18, 17}},
      seams{{0, 1, 2}};
  const std::vector<std::array<float, 3>> points{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  const std::vector<std::uint32_t> owners{1, 17, 16};
  view.cloths[0].topology_version = 1;
  view.cloths[0].triangles = left;
  view.cloths[0].seams = seams;
  view.cloths[0].seam_points = points;
  view.cloths[0].seam_particles = owners;
  const auto animation = open_animation(folder / "run.obj", view);
  animation->append(view);
  animation->finish();
  std::istringstream lines(folder.read("run_0000.obj"));
  std::vector<std::string> faces, vertices;
  for (std::string line; std::getline(lines, line);)
    if (line[0] != 'o') (line[0] == 'f' ? faces : vertices).push_back(line);
  EXPECT_EQ(faces, (std::vector<std::string>{"f 1 2 4", "f 2 3 5", "f 3 6 5", "f 7 8 9",
                                             "f 10 11 13 12"}));
  ASSERT_EQ(vertices.size(), 6U + 3 + 4);
  EXPECT_EQ(vertices[7], "v 4 5 6");
}

TEST(Obj, IsASequenceOfCompleteFiles) {
  const Folder folder;
  const Sheet sheet(3, 2);
  const auto animation = open_animation(folder / "run.obj", view_of({&sheet}));
  for (int sample = 0; sample < 3; ++sample) animation->append(view_of({&sheet}));
  EXPECT_FALSE(folder.has("run_0000.obj"));
  animation->finish();
  EXPECT_EQ(folder.files(), 3U);
  EXPECT_TRUE(folder.has("run_0000.obj"));
  EXPECT_TRUE(folder.has("run_0002.obj"));
  EXPECT_EQ(animation->written(), (folder / "run_0000.obj") + " … " + (folder / "run_0002.obj"));
}

TEST(Obj, LeavesTheOldSequenceWhenTheRunIsGivenUp) {
  const Folder folder;
  const Sheet sheet(3, 2);
  folder.write("run_0000.obj", "old");
  {
    const auto animation = open_animation(folder / "run.obj", view_of({&sheet}));
    for (int sample = 0; sample < 3; ++sample) animation->append(view_of({&sheet}));
  }
  EXPECT_EQ(folder.read("run_0000.obj"), "old");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(Obj, TellsOfFilesThatALongerRunLeft) {
  const Folder folder;
  const Sheet sheet(3, 2);
  folder.write("run_0001.obj", "old");
  const auto animation = open_animation(folder / "run.obj", view_of({&sheet}));
  animation->append(view_of({&sheet}));
  animation->finish();
  EXPECT_NE(animation->written().find("run_0001.obj and what follows"), std::string::npos)
      << animation->written();
}

TEST(Obj, HasOneObjectOfQuadsPerCloth) {
  const Folder folder;
  const Sheet one(3, 2);
  const Sheet two(2, 2);
  const auto animation = open_animation(folder / "run.obj", view_of({&one, &two}));
  animation->append(view_of({&one, &two}));
  animation->finish();
  std::istringstream lines(folder.read("run_0000.obj"));
  std::vector<std::string> objects, faces;
  std::size_t vertices = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line[0] == 'o') objects.push_back(line);
    if (line[0] == 'v') ++vertices;
    if (line[0] == 'f') faces.push_back(line);
  }
  EXPECT_EQ(objects, (std::vector<std::string>{"o cloth_0", "o cloth_1"}));
  EXPECT_EQ(vertices, 10U);
  EXPECT_EQ(faces, (std::vector<std::string>{"f 1 2 5 4", "f 2 3 6 5", "f 7 8 10 9"}));
}

TEST(Obj, CoordinatesReadBackToTheSameBits) {
  const Folder folder;
  const Sheet sheet(2, 2);
  const auto animation = open_animation(folder / "run.obj", view_of({&sheet}));
  animation->append(view_of({&sheet}));
  animation->finish();
  std::istringstream lines(folder.read("run_0000.obj"));
  std::string skipped;
  std::getline(lines, skipped);
  std::string letter, x, y;
  lines >> letter >> x >> y;
  EXPECT_EQ(std::stof(y), 1.0F / 3.0F);
}

TEST(Animation, ChecksThePathBeforeTheFirstSample) {
  const Folder folder;
  const Sheet sheet(2, 2);
  for (const std::string& extension : animation_extensions()) {
    EXPECT_THROW(open_animation(folder / ("missing/a" + extension), view_of({&sheet})), WriteError);
  }
}

TEST(Animation, RefusesUnknownExtensions) {
  const Sheet sheet(2, 2);
  EXPECT_THROW(open_animation("a.xyz", view_of({&sheet})), std::invalid_argument);
  EXPECT_THROW(open_animation("a", view_of({&sheet})), std::invalid_argument);
}

}  // namespace
}  // namespace weft
