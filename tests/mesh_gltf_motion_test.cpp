// Animations of glTF files: nodes, skins and morph targets, against closed forms in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "made_up_gltf.h"

namespace weft {
namespace {

using Json = text::Json;
using Motion = std::function<Vec3(const Vec3& p, double time)>;
constexpr double kPi = std::numbers::pi;

// Where a vertex is, straight from sample to sample.
Vec3 place_of(const PointCache& cache, std::size_t vertex, double time) {
  int n = 0;
  while (n + 1 < cache.samples() && double(cache.times[std::size_t(n + 1)]) <= time) ++n;
  const int after = std::min(n + 1, cache.samples() - 1);
  const double from = double(cache.times[std::size_t(n)]),
               to = double(cache.times[std::size_t(after)]);
  const double share = to > from ? std::clamp((time - from) / (to - from), 0.0, 1.0) : 0;
  Vec3 p;
  for (std::size_t k = 0; k < 3; ++k)
    p[k] = (1 - share) * double(cache.sample(n)[vertex][k]) +
           share * double(cache.sample(after)[vertex][k]);
  return p;
}

// The greatest distance of the animation's vertices from where they should be, from `begin` to `end`.
double off(const PointCache& cache, const std::vector<Vec3>& from, double begin, double end,
           const Motion& truth) {
  EXPECT_EQ(std::size_t(cache.points), from.size());
  if (std::size_t(cache.points) != from.size()) return 1e300;
  double most = 0;
  for (int n = 0; n <= 487; ++n) {
    const double time = begin + n * (end - begin) / 487;
    for (std::size_t v = 0; v < from.size(); ++v) {
      const Vec3 p = place_of(cache, v, time), q = truth(from[v], time);
      most = std::max(most, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    }
  }
  return most;
}

TEST(MeshGltfMotion, AnArmBendsByItsSkin) {
  const auto mesh = tube();
  for (const int sets : {1, 3})
    for (const bool whole : {false, true}) {
      Arm arm(mesh, sets, whole);
      arm.file.channel(3, "rotation", {0.5, 2}, joined({turn({0, 0, 1}, 0), turn({0, 0, 1}, 90)}));
      const PointCacheFile file = motion_of(arm.file);
      ASSERT_TRUE(file.cache) << told(file);
      EXPECT_EQ(told(file), "");
      const double rounded = whole ? 0.5 / 255 * std::sqrt(2.0) : 0;
      const double most = off(*file.cache, mesh->vertices, 0, 2.5, [](const Vec3& p, double t) {
        return Arm::bent(p, std::clamp((t - 0.5) / 1.5, 0.0, 1.0) * kPi / 2);
      });
      EXPECT_LT(most, 2e-4 + rounded);  // 1e-4 of the length of the arm
      EXPECT_LT(file.cache->samples(), 80);
      // Of the mesh by itself: as the file's nodes put it.
      const MeshFile rest = read_gltf(arm.file.write(), "a.gltf", "");
      ASSERT_EQ(rest.mesh.vertices.size(), mesh->vertices.size()) << told(rest);
      for (std::size_t v = 0; v < mesh->vertices.size(); ++v) {
        const Vec3 q = Arm::bent(mesh->vertices[v], 0);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(rest.mesh.vertices[v][k], q[k], 1e-6);
      }
      EXPECT_EQ(rest.mesh.triangles, mesh->triangles);
      EXPECT_EQ(told(rest), "");
    }
}

TEST(MeshGltfMotion, AnArmThatIsBentAtRestIsReadBent) {
  Arm arm(tube());
  arm.file.document["nodes"][3]["rotation"] = turn({0, 0, 1}, 90);
  const MeshFile rest = read_gltf(arm.file.write_glb(), "a.glb", "");
  ASSERT_EQ(told(rest), "");
  for (std::size_t v = 0; v < rest.mesh.vertices.size(); ++v) {
    const Vec3 q = Arm::bent(arm.mesh->vertices[v], kPi / 2);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(rest.mesh.vertices[v][k], q[k], 1e-6);
  }
}

// A ball that grows by one target and is drawn out by another: listed in full, and sparse.
TEST(MeshGltfMotion, MorphTargetsMoveVertices) {
  const auto mesh = tests::ball(16, 10, 0.5);
  for (const bool sparse : {false, true}) {
    GltfMaker file;
    file.node({{"mesh", file.mesh(*mesh)}});
    std::vector<Vec3> grown = mesh->vertices;
    std::vector<double> few, numbers;
    for (std::size_t v = 0; v < mesh->vertices.size(); ++v)
      if (mesh->vertices[v][1] > 0.1)
        numbers.push_back(double(v)), few.insert(few.end(), {0, 1.5, 0});
    Json& targets = file.primitive()["targets"];
    targets.push_back({{"POSITION", file.floats(GltfMaker::flat(grown), "VEC3")}});
    if (sparse) {
      file.document["accessors"].push_back(
          {{"componentType", 5126}, {"count", mesh->vertices.size()}, {"type", "VEC3"}});
      const int target = int(file.document["accessors"].size()) - 1;
      const int indices = file.shorts(numbers, "SCALAR"), values = file.floats(few, "VEC3");
      const auto view = [&](int a) {
        return file.document["accessors"][std::size_t(a)]["bufferView"];
      };
      file.document["accessors"][std::size_t(target)]["sparse"] = {
          {"count", numbers.size()},
          {"indices", {{"bufferView", view(indices)}, {"componentType", 5123}}},
          {"values", {{"bufferView", view(values)}}}};
      targets.push_back({{"POSITION", target}});
    } else {
      std::vector<double> all(3 * mesh->vertices.size());
      for (const double v : numbers) all[3 * std::size_t(v) + 1] = 1.5;
      targets.push_back({{"POSITION", file.floats(all, "VEC3")}});
    }
    file.document["meshes"][0]["weights"] = {0.0, 0.5};
    const auto up = [](const Vec3& p) { return p[1] > 0.1 ? 1.5 : 0; };
    const MeshFile rest = read_gltf(file.write(), "a.gltf", "");
    for (std::size_t v = 0; v < mesh->vertices.size(); ++v)
      EXPECT_NEAR(rest.mesh.vertices[v][1], mesh->vertices[v][1] + 0.5 * up(mesh->vertices[v]),
                  1e-6);
    file.channel(0, "weights", {0, 1, 3}, {0, 0, 1, 0.25, -0.5, 1});
    const PointCacheFile moved = motion_of(file);
    ASSERT_TRUE(moved.cache) << told(moved);
    EXPECT_EQ(moved.cache->samples(), 3);  // it is straight between keys
    const double most = off(*moved.cache, mesh->vertices, -1, 4, [&](const Vec3& p, double t) {
      const double s = std::clamp(t, 0.0, 3.0);
      const double a = s < 1 ? s : 1 - 0.75 * (s - 1),
                   b = s < 1 ? 0.25 * s : 0.25 + 0.375 * (s - 1);
      return Vec3{p[0] * (1 + a), p[1] * (1 + a) + b * up(p), p[2] * (1 + a)};
    });
    EXPECT_LT(most, 1e-6);
  }
}

// Nodes below nodes: one turns by more than half a turn, one below is off its axis, scaled, and moves.
TEST(MeshGltfMotion, NodesCarryWhatIsBelowThem) {
  const auto mesh = tests::box({0.5, 0.1, 0.2});
  GltfMaker file;
  file.mesh(*mesh);
  file.node({{"children", {1}}, {"translation", {1, 2, 3}}});
  file.node({{"mesh", 0}, {"scale", {2, 1, 1}}});
  const Vec3 axis{0.6, 0, 0.8};
  std::vector<double> back =
      turn(axis, 240);  // -q is the same turn: keys are joined the shorter way
  for (double& value : back) value = -value;
  file.channel(0, "rotation", {0, 1, 2}, joined({turn(axis, 0), turn(axis, 120), back}));
  file.channel(1, "translation", {0, 2}, {0.5, 0, 0, 0.5, 1, 0});
  const PointCacheFile moved = motion_of(file);
  ASSERT_TRUE(moved.cache) << told(moved);
  const double most = off(*moved.cache, mesh->vertices, 0, 2, [&](const Vec3& p, double t) {
    const Vec3 q{2 * p[0] + 0.5, p[1] + 0.5 * t, p[2]};
    const double angle = 120 * t * kPi / 180, c = std::cos(angle), s = std::sin(angle);
    const double along = axis[0] * q[0] + axis[1] * q[1] + axis[2] * q[2];
    const Vec3 side{axis[1] * q[2] - axis[2] * q[1], axis[2] * q[0] - axis[0] * q[2],
                    axis[0] * q[1] - axis[1] * q[0]};
    Vec3 r{1, 2, 3};
    for (std::size_t k = 0; k < 3; ++k) r[k] += c * q[k] + s * side[k] + (1 - c) * along * axis[k];
    return r;
  });
  EXPECT_LT(most, 2.1e-4);
  EXPECT_GT(most, 1e-7);
}

// However soon it comes after the one before.
TEST(MeshGltfMotion, TheLastKeyIsWhereTheMotionEnds) {
  for (const double last : {1.00005, 1.5}) {
    GltfMaker file;
    const auto ball = tests::ball(9, 7, 1);
    file.mesh(*ball);
    file.node({{"mesh", 0}});
    file.channel(0, "translation", {0, 1, last}, {0, 0, 0, 0, 0, 0, 3, 0, 0});
    const PointCacheFile read = motion_of(file);
    ASSERT_TRUE(read.cache) << told(read);
    EXPECT_NEAR(place_of(*read.cache, 0, 2)[0], ball->vertices[0][0] + 3, 1e-5) << last;
  }
}

TEST(MeshGltfMotion, CubicSplinesAndSteps) {
  const auto mesh = tests::box({0.5, 0.5, 0.5});
  GltfMaker file;
  file.mesh(*mesh);
  file.node({{"mesh", 0}});
  // x: t³ from 1 to 3, whose tangents are 3 and 27; y: an ease from 0 to 1, through the middle of the straight way.
  file.channel(0, "translation", {1, 3},
               {0, 0, 0, /**/ 1, 0, 0, /**/ 3, 0, 0, /**/ 27, 0, 0, /**/ 27, 1, 0, /**/ 0, 0, 0},
               "CUBICSPLINE");
  file.channel(0, "scale", {0, 1, 1.01}, {1, 1, 1, 2, 1, 1, 3, 1, 1}, "STEP");
  const PointCacheFile moved = motion_of(file);
  ASSERT_TRUE(moved.cache) << told(moved);
  EXPECT_EQ(told(moved),
            "a.gltf: values that jump from key to key do so within 1/60 s before a key\n");
  const double most = off(*moved.cache, mesh->vertices, 0, 3, [](const Vec3& p, double time) {
    const double t = std::clamp(time, 1.0, 3.0), s = (t - 1) / 2;
    const double first = std::clamp((time - (1 - 1.0 / 60)) * 60, 0.0, 1.0);
    const double next = std::clamp((time - 1.005) / 0.005, 0.0, 1.0);
    return Vec3{(1 + first + next) * p[0] + t * t * t, p[1] + s * s * (3 - 2 * s), p[2]};
  });
  EXPECT_LT(most, 1.2e-4);
  for (int n = 1; n < moved.cache->samples(); ++n)
    EXPECT_GE(moved.cache->times[std::size_t(n)] - moved.cache->times[std::size_t(n - 1)], 1e-4F);
}

// A spline of quaternions without tangents eases, and is brought to length 1.
TEST(MeshGltfMotion, CubicTurnsAreTurns) {
  const auto mesh = tests::box({0.5, 0.25, 0.5});
  GltfMaker file;
  file.mesh(*mesh);
  file.node({{"mesh", 0}});
  const std::vector<double> none(4);
  file.channel(0, "rotation", {0, 1},
               joined({none, turn({0, 1, 0}, 0), none, none, turn({0, 1, 0}, 120), none}),
               "CUBICSPLINE");
  const PointCacheFile moved = motion_of(file);
  ASSERT_TRUE(moved.cache) << told(moved);
  const double most = off(*moved.cache, mesh->vertices, 0, 1, [](const Vec3& p, double t) {
    const double s = t * t * (3 - 2 * t), half = kPi / 3;  // of the turn
    const double y = s * std::sin(half), w = (1 - s) + s * std::cos(half);
    const double angle = 2 * std::atan2(y, w), c = std::cos(angle), sine = std::sin(angle);
    return Vec3{c * p[0] + sine * p[2], p[1], c * p[2] - sine * p[0]};
  });
  EXPECT_LT(most, 1.1e-4);
}

}  // namespace
}  // namespace weft
