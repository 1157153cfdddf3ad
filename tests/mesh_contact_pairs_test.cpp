// What contact finds of a crumpled mesh and a grid beside it, against all pairs in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "made_up_mesh.h"
#include "physics/contact/self/crossings.h"
#include "physics/contact/self/self_contact.h"
#include "physics/frame/cloth_step.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

constexpr int kPoints = 9;
constexpr double kSpacing = 1.0 / (kPoints - 1);

// A mesh, and a grid that lies through it.
Scene scene_of(SelfCollisionMode mode, double thickness, unsigned seed) {
  Scene scene;
  scene.cloths.resize(2);
  scene.cloths[0].mesh.shape =
      made_up({.nx = kPoints, .ny = kPoints, .shift = 0.3, .shuffled = true, .seed = seed});
  scene.cloths[1].grid = {6, 5, {0.2, 0.03, 0.2}, {0.6, 0, 0}, {0, 0, 0.5}, 0};
  for (Cloth& cloth : scene.cloths) {
    cloth.self_collision.mode = mode;
    cloth.self_collision.thickness = thickness;
  }
  return scene;
}

struct Sheets {
  explicit Sheets(const Scene& of) : scene(of) {
    for (int c = 0; c < 2; ++c)
      steps.push_back(
          std::make_unique<ClothStep>(scene, c, Method::spring, 1, kernel_table(Simd::best)));
    for (std::size_t c = 0; c < 2; ++c) {
      const std::vector<Vec3> at = steps[c]->particles().gather(steps[c]->particles().x);
      rest.insert(rest.end(), at.begin(), at.end());
      sheet.resize(rest.size(), c);
    }
  }
  // Folds the first sheets in waves, and moves every particle at random.
  void crumple(std::size_t sheets, double waves, double shake, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> by(-shake, shake);
    for (std::size_t c = 0; c < sheets; ++c) {
      Particles& p = steps[c]->particles();
      p.for_each([&](int j, int i) {
        const Vec3 at = p.position(j, i);
        const Vec3 to{0.5 + 0.1 * std::sin(waves * at[0]) + by(random),
                      0.2 * at[0] + at[1] + 0.1 * std::cos(waves * at[0]) + by(random),
                      at[2] + by(random)};
        for (int k = 0; k < 3; ++k) p.x.at(k, j, i) = float(to[std::size_t(k)]);
      });
    }
    x.clear(), faces.clear();
    for (const auto& step : steps) add_surface(step->model(), x, faces);
  }
  SelfContact::Overlaps overlaps() const {
    return SelfContact::make(scene, models_of(steps), kernel_table(Simd::best))->overlaps();
  }

  const Scene scene;
  std::vector<std::unique_ptr<ClothStep>> steps;
  std::vector<Vec3> rest, x;
  std::vector<std::size_t> sheet;  // of every particle
  std::vector<Face> faces;
};

// The shortest ways along edges (Floyd 1962).
std::vector<std::vector<double>> ways(const Sheets& s) {
  std::vector<std::vector<double>> way(s.x.size(), std::vector<double>(s.x.size(), 1e300));
  for (const auto& [a, b] : edges_of(s.faces)) {
    const double l = length(minus(s.rest[std::size_t(a)], s.rest[std::size_t(b)]));
    way[std::size_t(a)][std::size_t(b)] = way[std::size_t(b)][std::size_t(a)] = l;
  }
  for (std::size_t k = 0; k < s.x.size(); ++k)
    for (std::size_t a = 0; a < s.x.size(); ++a)
      for (std::size_t b = 0; b < s.x.size(); ++b)
        way[a][b] = std::min(way[a][b], way[a][k] + way[k][b]);
  return way;
}

TEST(MeshContactPairs, OfParticlesAreThoseOfBruteForce) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const double thickness = (0.6 + 0.5 * seed) * kSpacing;
    Sheets s(scene_of(SelfCollisionMode::particles, thickness, seed));
    s.crumple(2, 12, 0.02, seed);
    const auto way = ways(s);
    std::int64_t pairs = 0;
    double deepest = 0;
    for (std::size_t a = 0; a < s.x.size(); ++a)
      for (std::size_t b = a + 1; b < s.x.size(); ++b) {
        const double missing = thickness - length(minus(s.x[a], s.x[b]));
        if (missing <= 0) continue;
        const bool near = length(minus(s.rest[a], s.rest[b])) < 1.3 * thickness;
        if (s.sheet[a] == s.sheet[b] && near && (s.sheet[a] == 1 || way[a][b] < 2.6 * thickness))
          continue;
        ++pairs;
        deepest = std::max(deepest, missing);
      }
    const SelfContact::Overlaps found = s.overlaps();
    EXPECT_GT(pairs, 10) << seed;
    EXPECT_EQ(found.pairs, pairs) << seed;
    EXPECT_NEAR(found.deepest, deepest, 1e-5) << seed;
  }
}

// Two things of a sheet's surface, and where on each they are nearest: shares of at most four particles.
struct Near {
  std::array<std::int32_t, 4> body;
  std::array<double, 4> share;
};

class Counted {
 public:
  explicit Counted(const Sheets& s) : s_(s), h_(s.scene.cloths[0].self_collision.thickness) {}

  // Whether both are of one sheet and nearer than they are kept apart.
  void add(const Near& near) {
    Vec3 off{}, at_rest{};
    for (std::size_t k = 0; k < 4; ++k) {
      off = plus(off, times(s_.x[std::size_t(near.body[k])], near.share[k]));
      at_rest = plus(at_rest, times(s_.rest[std::size_t(near.body[k])], near.share[k]));
    }
    const bool one = s_.sheet[std::size_t(near.body[0])] == s_.sheet[std::size_t(near.body[3])];
    const double held = one ? std::min(h_, length(at_rest) / 2 / 1.02) : h_;
    pairs += length(off) < held;
  }
  void vertex(std::int32_t v, const Face& f) {
    if (v == f[0] || v == f[1] || v == f[2]) return;
    const Vec3 &a = at(f[0]), e = minus(at(f[1]), a), g = minus(at(f[2]), a), d = minus(at(v), a);
    const double ee = dot(e, e), eg = dot(e, g), gg = dot(g, g), area = ee * gg - eg * eg;
    const double t = (gg * dot(d, e) - eg * dot(d, g)) / area;
    const double u = (ee * dot(d, g) - eg * dot(d, e)) / area;
    if (std::min({t, u, 1 - t - u}) > -0.02) add({{v, f[0], f[1], f[2]}, {1, t + u - 1, -t, -u}});
  }
  void edges(const Edge& a, const Edge& b) {
    if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) return;
    const Vec3 e = minus(at(a[1]), at(a[0])), f = minus(at(b[1]), at(b[0]));
    const Vec3 r = minus(at(a[0]), at(b[0]));
    const double ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), area = ee * ff - ef * ef;
    if (area <= 1e-3 * ee * ff) return;
    const double s = (ef * dot(f, r) - dot(e, r) * ff) / area;
    const double t = (ee * dot(f, r) - ef * dot(e, r)) / area;
    if (std::min(s, t) >= 0 && std::max(s, t) <= 1)
      add({{a[0], a[1], b[0], b[1]}, {1 - s, s, t - 1, -t}});
  }
  std::int64_t pairs = 0;

 private:
  const Vec3& at(std::int32_t n) const { return s_.x[std::size_t(n)]; }
  const Sheets& s_;
  const double h_;
};

// Of the mesh with itself.
TEST(MeshContactPairs, OfSurfacesAreThoseOfBruteForce) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    Scene scene = scene_of(SelfCollisionMode::surface, (0.15 + 0.1 * seed) * kSpacing, seed);
    scene.cloths[1].grid.origin = {5, 5, 5};
    Sheets s(scene);
    s.crumple(1, seed % 2 == 0 ? 12 : 25, seed % 3 == 0 ? 0.03 : 0.01, seed);
    Counted counted(s);
    const std::vector<Edge> edges = edges_of(s.faces);
    for (std::int32_t v = 0; v < std::int32_t(s.x.size()); ++v)
      for (const Face& f : s.faces)
        if (s.sheet[std::size_t(v)] == 0 && s.sheet[std::size_t(f[0])] == 0) counted.vertex(v, f);
    for (std::size_t a = 0; a < edges.size(); ++a)
      for (std::size_t b = a + 1; b < edges.size(); ++b)
        if (s.sheet[std::size_t(edges[a][0])] == 0 && s.sheet[std::size_t(edges[b][0])] == 0)
          counted.edges(edges[a], edges[b]);
    EXPECT_GT(counted.pairs, 20) << seed;
    EXPECT_EQ(s.overlaps().pairs, counted.pairs) << seed;
  }
}

}  // namespace
}  // namespace weft::physics
