// Point caches as they are read: of both kinds, and what is wrong with them.
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "body_scenes.h"
#include "contact_scenes.h"
#include "folder.h"
#include "made_up_bodies.h"
#include "output/bytes.h"
#include "weft/output.h"
#include "weft/point_cache.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

std::string pc2(int points, int samples, float first, float step, int version = 1) {
  std::string bytes("POINTCACHE2\0", 12);
  append_little_endian(bytes, std::int32_t{version});
  append_little_endian(bytes, std::int32_t{points});
  append_little_endian(bytes, first);
  append_little_endian(bytes, step);
  append_little_endian(bytes, std::int32_t{samples});
  return bytes;
}

std::string with_places(std::string bytes, int count, float value = 1) {
  for (int n = 0; n < 3 * count; ++n) append_little_endian(bytes, value + float(n));
  return bytes;
}

std::string fault_of(const std::string& bytes, const std::string& name = "a.pc2", int points = 2) {
  const PointCacheFile file = parse_point_cache(bytes, name, points);
  EXPECT_EQ(file.cache == nullptr, !file.faults.empty());
  return file.faults.empty() ? ""
                             : file.faults[0].place + ": " + file.faults[0].what + " (" +
                                   file.faults[0].allowed + ")";
}

TEST(MeshCache, BothKindsAreRead) {
  const PointCacheFile file = parse_point_cache(with_places(pc2(2, 3, 1, 0.5F), 6), "a.pc2", 2);
  ASSERT_TRUE(file.cache);
  EXPECT_TRUE(file.cache->in_frames);
  EXPECT_EQ(file.cache->times, (std::vector<float>{1, 1.5, 2}));
  EXPECT_EQ(file.cache->sample(2)[1], (PointCache::Place{16, 17, 18}));
  const PointCacheFile again = parse_point_cache(mdd_bytes(*file.cache), "a.mdd", 2);
  ASSERT_TRUE(again.cache);
  EXPECT_FALSE(again.cache->in_frames);
  EXPECT_EQ(again.cache->times, file.cache->times);
  EXPECT_EQ(again.cache->places, file.cache->places);
}

TEST(MeshCache, WhatIsWrongIsNamed) {
  EXPECT_EQ(fault_of("", "a.abc"), "a.abc: the file is of no known kind (.pc2, .mdd, .glb, .gltf)");
  EXPECT_EQ(fault_of("POINTCACHE"),
            "a.pc2: the file does not begin as a .pc2 file does (POINTCACHE2 and 20 bytes more)");
  EXPECT_EQ(fault_of(pc2(2, 1, 0, 1, 7)), "a.pc2: the version is 7 (1)");
  EXPECT_EQ(fault_of(pc2(3, 1, 0, 1)),
            "a.pc2: the file has 3 points (2, the vertices of the mesh)");
  EXPECT_EQ(fault_of(pc2(2, 0, 0, 1)), "a.pc2: the file has 0 samples (at least 1)");
  EXPECT_EQ(fault_of(pc2(2, -5, 0, 1)), "a.pc2: the file has -5 samples (at least 1)");
  EXPECT_EQ(fault_of(pc2(2, 2147483647, 0, 1)),
            "a.pc2: the file has 32 bytes (51539607560, by its header)");
  EXPECT_EQ(fault_of(with_places(pc2(2, 2, 0, 1), 3)),
            "a.pc2: the file has 68 bytes (80, by its header)");
  EXPECT_EQ(fault_of(with_places(pc2(2, 2, 0, 0), 4)),
            "a.pc2: samples are 0.000000 frames apart (above 0)");
  EXPECT_EQ(fault_of(with_places(pc2(2, 2, std::nanf(""), 1), 4)),
            "a.pc2: the time of sample 1 is nan (-1e6 to 1e6)");
  std::string broken = with_places(pc2(2, 2, 0, 1), 4);
  broken.replace(broken.size() - 4, 4, std::string("\0\0\x80\x7f", 4));
  EXPECT_EQ(fault_of(broken), "a.pc2: point 2 of sample 2 is inf (finite numbers)");
  PointCache late;
  late.points = 2;
  late.times = {1, 1};
  late.places.resize(4);
  EXPECT_EQ(fault_of(mdd_bytes(late), "a.mdd"),
            "a.mdd: the time of sample 2 is 1.000000, and the one before it is no earlier (times "
            "that increase)");
  EXPECT_EQ(fault_of("1234567", "a.mdd"),
            "a.mdd: the file does not begin as an .mdd file does (8 bytes at least)");
}

// Bytes drawn, turned and cut: a fault or a cache, never anything else.
TEST(MeshCache, AnyBytesAreReadOrRefused) {
  std::mt19937 random(1);
  const std::string sound = with_places(pc2(2, 3, 0, 1), 6);
  const std::string other = mdd_bytes(*parse_point_cache(sound, "a.pc2", 2).cache);
  int read = 0;
  for (int n = 0; n < 20000; ++n) {
    const bool mdd = random() % 2 == 0;
    std::string bytes = mdd ? other : sound;
    for (int k = int(random() % 4); k > 0; --k) bytes[random() % bytes.size()] = char(random());
    if (random() % 8 == 0) bytes.resize(random() % bytes.size());
    const PointCacheFile file =
        parse_point_cache(bytes, mdd ? "a.mdd" : "a.pc2", random() % 2 ? 2 : kAnyPoints);
    ASSERT_EQ(file.cache == nullptr, !file.faults.empty());
    if (!file.cache) continue;
    ++read;
    ASSERT_EQ(file.cache->places.size(),
              std::size_t(file.cache->points) * std::size_t(file.cache->samples()));
  }
  EXPECT_GT(read, 1000);
}

TEST(MeshCache, ScenesNameThem) {
  const Folder folder;
  const auto mesh = tests::box({1, 1, 1});
  folder.write("body.obj", write_obj(*mesh));
  PointCache cache;
  cache.points = 8;
  cache.in_frames = true;
  cache.times = {0, 30};
  for (const double up : {0.0, 2.0})
    for (const Vec3& p : mesh->vertices)
      cache.places.push_back({float(p[0]), float(p[1] + up), float(p[2])});
  std::string walk = pc2(8, 2, 0, 30);
  for (const PointCache::Place& place : cache.places)
    for (const float value : place) append_little_endian(walk, value);
  folder.write("walk.pc2", walk);
  const auto scene = [&](const std::string& more) {
    folder.write(
        "scene.json",
        scene_with(R"({"mesh": {"file": "body.obj", "scale": 0.1, "translate": [0, 1, 0]}, )" +
                   more + "}"));
    return read_scene(folder / "scene.json");
  };
  const SceneFile file = scene(R"("animation": "walk.pc2")");
  ASSERT_TRUE(file.faults.empty()) << first_fault(file);
  // 0.1 m above its place after 15 frames of 1/60 s, 0.2 m after 30, and then on.
  const Collider& body = file.scene.colliders[0];
  EXPECT_NEAR(signed_distance(body, 0, {0, 1.5, 0}), 0.4, 1e-6);
  EXPECT_NEAR(signed_distance(body, 0.25, {0, 1.5, 0}), 0.3, 1e-6);
  EXPECT_NEAR(signed_distance(body, 5, {0, 1.5, 0}), 0.2, 1e-6);
  const SceneFile again = read_scene(folder.write("again.json", write_scene_text(file.scene)));
  EXPECT_EQ(again.scene.colliders, file.scene.colliders);
  EXPECT_NE(write_scene_text(file.scene).find("walk.pc2"), std::string::npos);
  const SceneFile slow = read_scene(folder / "scene.json", {{"/time/frame", "0.05"}});
  EXPECT_NEAR(signed_distance(slow.scene.colliders[0], 0.75, {0, 1.5, 0}), 0.3, 1e-6);

  EXPECT_EQ(first_fault(scene(R"("animation": "none.pc2")")),
            "/colliders/0/animation: " + (folder / "none.pc2") + ": there is no such point cache");
  folder.write("short.pc2", walk.substr(0, 100));
  EXPECT_EQ(first_fault(scene(R"("animation": "short.pc2")")),
            "/colliders/0/animation: " + (folder / "short.pc2") + ": the file has 100 bytes");
  std::string flat = walk;
  std::copy(flat.begin() + 32, flat.begin() + 44, flat.begin() + 44);
  folder.write("flat.pc2", flat);
  EXPECT_EQ(first_fault(scene(R"("animation": "flat.pc2")")),
            "/colliders/0/animation: sample 1 of the animation has an edge of 0 m, between vertices 0 "
            "and 1 (counted from 0)");
  folder.write("ball.json", scene_with(R"({"sphere": {"radius": 0.1}, "animation": "walk.pc2"})"));
  EXPECT_EQ(first_fault(read_scene(folder / "ball.json")),
            "/colliders/0/animation: a sphere has an animation");
  folder.write("pin.json",
               R"({"weft": 1, "cloths": [{"grid": {"points": [8, 8], "origin": [-0.5, 3, -0.5]},
      "pins": [{"at": [0, 0], "follow": 0}]}], "colliders": [{"mesh": {"file": "body.obj"}, "animation": "walk.pc2"}]})");
  EXPECT_EQ(first_fault(read_scene(folder / "pin.json")), "");
}

}  // namespace
}  // namespace weft
