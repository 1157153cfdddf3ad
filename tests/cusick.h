// The drape test of Cusick (BS 5058): a round disc of cloth hangs over a smaller one, and its drape coefficient is
// the area of the shadow beside the support, as a share of the flat ring's. The shipped scene `cusick`, with meshes
// of any fineness.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "weft/mesh.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft::cusick {

inline constexpr double kDisc = 0.15, kSupport = 0.09;  // m, radii

// A disc as scripts/round_mesh makes them: rings of 6, 12, 18 … points about the middle, and a rim that is not quite
// level, since a disc that is has no reason to fold at one place rather than another.
struct Disc {
  int rings = 20;
  double turn = 0;         // degrees, of the mesh against waves and warp
  double waves = 0.00667;  // of the radius; height of each of 8 waves about the rim
  double phase = 2.4;      // rad, which tells one specimen from another
};

// As a share of the disc's. An energy of curvature that counts on both sides of a held edge clamps half an edge within
// it: the last held ring lies half an edge beyond the support's rim.
inline int held_rings(int rings) {
  return int(std::lround(rings * kSupport / kDisc));
}
inline double ring_radius(int ring, int rings) {
  const int held = held_rings(rings), free = rings - held;
  const double last = (2 * free * kSupport / kDisc + 1) / (2 * free + 1);
  return ring <= held ? last * ring / held : last + (1 - last) * (ring - held) / free;
}

inline std::shared_ptr<TriangleMesh> disc(const Disc& d) {
  auto mesh = std::make_shared<TriangleMesh>();
  const auto point = [&](int ring, int k) {
    const double angle = std::numbers::pi * (d.turn / 180 + (ring ? k / (3.0 * ring) : 0));
    const double radius = ring_radius(ring, d.rings);
    double height = 0;
    for (int n = 2; n < 10; ++n) height += std::cos(n * angle + d.phase * n * n);
    mesh->vertices.push_back(
        {radius * std::cos(angle), radius * std::sin(angle), d.waves * radius * radius * height});
  };
  for (int ring = 0; ring <= d.rings; ++ring)
    for (int k = 0; k < std::max(1, 6 * ring); ++k) point(ring, k);
  const auto number = [](int ring, int k) {
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + k % (6 * ring);
  };
  for (int ring = 1; ring <= d.rings; ++ring)
    for (int sector = 0; sector < 6; ++sector)
      for (int k = 0; k < ring; ++k) {
        const int out = sector * ring + k, within = sector * (ring - 1) + k;
        const int a = number(ring, out), b = number(ring, out + 1), c = number(ring - 1, within);
        mesh->triangles.push_back({c, a, b});
        if (k + 1 < ring) mesh->triangles.push_back({c, b, number(ring - 1, within + 1)});
      }
  std::vector<int> held(std::size_t(number(held_rings(d.rings) + 1, 0)));
  std::iota(held.begin(), held.end(), 0);
  mesh->groups = {{"held", held}};
  for (const auto& corners : mesh->triangles) {  // the warp goes along x
    std::array<TriangleMesh::Uv, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& v = mesh->vertices[std::size_t(corners[k])];
      uv[k] = {v[0], v[1]};
    }
    mesh->uv.push_back(uv);
  }
  return mesh;
}

// The shipped scene with another fabric and another mesh.
inline Scene scene_of(const std::string& fabric, const Disc& d,
                      std::vector<Override> overrides = {}) {
  overrides.push_back({"/cloths/0/fabric", "\"" + fabric + "\""});
  const SceneFile file = read_scene("cusick", overrides);
  if (!file.faults.empty()) throw SceneError(file.faults);
  Scene scene = file.scene;
  scene.cloths[0].mesh.file.clear();
  scene.cloths[0].mesh.shape = disc(d);
  return scene;
}

// The area of the shadow of triangles from above, beside the support: on lines across, the length of the union of
// what triangles and support cover, less the support's. `places`: x, y, z of the vertices.
template <class Number>
double shadow(const std::vector<std::array<int, 3>>& triangles, const std::vector<Number>& places) {
  constexpr int kLines = 1500;  // 0.2 mm apart: the coefficient to 0.01 points
  constexpr double kReach = kDisc + 0.01, kApart = 2 * kReach / kLines;
  std::vector<std::vector<std::pair<double, double>>> covered(kLines);
  const auto height = [&](int line) { return (line + 0.5) * kApart - kReach; };
  for (const auto& corners : triangles) {
    std::array<double, 3> x, z;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = places[std::size_t(3 * corners[k])];
      z[k] = places[std::size_t(3 * corners[k] + 2)];
    }
    const auto [low, high] = std::minmax({z[0], z[1], z[2]});
    const int first = std::max(0, int((low + kReach) / kApart)),
              last = std::min(kLines - 1, int((high + kReach) / kApart));
    for (int line = first; line <= last; ++line) {
      double from = 1e9, to = -1e9;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if ((z[k] <= height(line)) == (z[next] <= height(line))) continue;
        const double at = x[k] + (height(line) - z[k]) / (z[next] - z[k]) * (x[next] - x[k]);
        from = std::min(from, at), to = std::max(to, at);
      }
      if (from < to) covered[std::size_t(line)].push_back({from, to});
    }
  }
  double area = 0;
  for (int line = 0; line < kLines; ++line) {
    auto& parts = covered[std::size_t(line)];
    const double chord2 = kSupport * kSupport - height(line) * height(line);
    const double half = chord2 > 0 ? std::sqrt(chord2) : 0;
    if (half > 0) parts.push_back({-half, half});
    std::ranges::sort(parts);
    double reached = -1e9, length = -2 * half;
    for (const auto& [from, to] : parts) {
      if (to > reached) length += to - std::max(from, reached);
      reached = std::max(reached, to);
    }
    area += length * kApart;
  }
  return area;
}

struct Drape {
  double coefficient = 0;  // %
  int folds = 0;           // waves of the rim
  double speed = 0;        // m/s, of the fastest vertex at the end
};

// Lets the disc come to rest.
inline Drape drape(const Scene& scene, const Options& options = {}) {
  const TriangleMesh& mesh = *scene.cloths[0].mesh.shape;
  Simulation run(scene, options);
  const auto flat = run.positions();
  while (run.time() < scene.time.seconds) run.advance_frame();
  const auto x = run.positions();
  run.advance_frame();
  const auto next = run.positions();
  Drape d;
  d.coefficient = 100 * shadow(mesh.triangles, x) / shadow(mesh.triangles, flat);
  for (std::size_t n = 0; n < x.size(); n += 3)
    d.speed = std::max(d.speed,
                       std::hypot(next[n] - x[n], next[n + 1] - x[n + 1], next[n + 2] - x[n + 2]) /
                           scene.time.frame);
  const int rings = int(std::lround((std::sqrt(12.0 * double(mesh.vertices.size()) - 3) - 3) / 6));
  const std::size_t rim = x.size() / 3 - std::size_t(6 * rings);
  const auto radius = [&](std::size_t k) {
    const std::size_t n = 3 * (rim + k % std::size_t(6 * rings));
    return std::hypot(double(x[n]), double(x[n + 2]));
  };
  double mean = 0;
  for (std::size_t k = 0; k < std::size_t(6 * rings); ++k) mean += radius(k) / (6 * rings);
  for (std::size_t k = 0; k < std::size_t(6 * rings); ++k)
    d.folds += radius(k) < mean && radius(k + 1) >= mean;
  return d;
}

}  // namespace weft::cusick
