// Point caches and OBJ sequences, read back by what their formats say.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "folder.h"
#include "made_up_cloth.h"
#include "weft/simulation.h"

namespace weft {
namespace {

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
  view.cloths[0].tear_triangles = seams;
  view.cloths[0].tear_points = points;
  view.cloths[0].tear_particles = owners;
  const auto animation = open_animation(folder / "run.obj", view);
  animation->append(view);
  animation->finish();
  std::istringstream lines(folder.read("run_0000.obj"));
  std::vector<std::string> faces, vertices;
  for (std::string line; std::getline(lines, line);)
    if (line[0] == 'f')
      faces.push_back(line);
    else if (line[1] == ' ' && line[0] == 'v')
      vertices.push_back(line);
  EXPECT_EQ(faces, (std::vector<std::string>{"f 1/1 2/2 4/4", "f 2/2 3/3 5/5", "f 3/3 6/6 5/5",
                                             "f 7 8 9", "f 10/7 11/8 13/10 12/9"}));
  ASSERT_EQ(vertices.size(), 6U + 3 + 4);
  EXPECT_EQ(vertices[7], "v 4 5 6");
}

// How many pieces hang together by vertices that faces share, without vertices of no face.
std::size_t pieces(const std::string& obj) {
  std::istringstream lines(obj);
  std::vector<std::size_t> parent{0};
  std::set<std::size_t> used;
  const auto root = [&](std::size_t v) {
    while (parent[v] != v) v = parent[v];
    return v;
  };
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, first;
    words >> word;
    if (word == "v") parent.push_back(parent.size());
    if (word != "f") continue;
    words >> first;
    used.insert(std::stoul(first));
    for (std::string corner; words >> corner; used.insert(std::stoul(corner)))
      parent[root(std::stoul(corner))] = root(std::stoul(first));
  }
  std::set<std::size_t> roots;
  for (const std::size_t v : used) roots.insert(root(v));
  return roots.size();
}

// What a cut leaves is as many surfaces, at the instant of the cut, when its sides lie on each other, and later.

TEST(Obj, ACutClothIsItsPieces) {
  const Folder folder;
  for (const bool open : {false, true}) {
    Scene scene;
    Cloth cloth;
    cloth.grid = {14, 11, {}, {1, 0, 0}, {0, 0, 0.8}, 0};
    cloth.pins.resize(1);
    cloth.cuts = {{{-1, 3.3}, {20, 7.7}}, {{6.5, -1}, {6.5, 20}}};
    scene.cloths = {cloth};
    Simulation simulation(scene);
    for (int k = 0; k < (open ? 20 : 0); ++k) simulation.advance_frame();
    const View view = simulation.view();
    ASSERT_GT(view.cloths[0].tear_points.size(), 50u);
    const auto animation = open_animation(folder / "run.obj", view);
    animation->append(view);
    animation->finish();
    EXPECT_EQ(pieces(folder.read("run_0000.obj")), 4u) << open;
  }
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
    if (line.starts_with("v ")) ++vertices;
    if (line[0] == 'f') faces.push_back(line);
  }
  EXPECT_EQ(objects, (std::vector<std::string>{"o cloth_0", "o cloth_1"}));
  EXPECT_EQ(vertices, 10U);
  EXPECT_EQ(faces, (std::vector<std::string>{"f 1/1 2/2 5/5 4/4", "f 2/2 3/3 6/6 5/5",
                                             "f 7/7 8/8 10/10 9/9"}));
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
