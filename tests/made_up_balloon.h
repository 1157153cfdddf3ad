// Balloons that tests make: balls of triangles about as large as each other.
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "weft/mesh.h"
#include "weft/simulation.h"

namespace weft {

// Every triangle of an octahedron parted in four along its edges, `times` over, and put on a ball about zero.
inline std::shared_ptr<TriangleMesh> made_up_balloon(int times, double radius) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const int x : {0, 1})
    for (const int y : {2, 3})
      for (const int z : {4, 5})
        mesh->triangles.push_back((x + y + z) % 2 == 0 ? std::array{x, y, z} : std::array{x, z, y});
  for (; times > 0; --times) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), int(mesh->vertices.size()));
      if (!fresh) return at->second;
      Vec3 p{};
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = mesh->vertices[std::size_t(a)][k] + mesh->vertices[std::size_t(b)][k];
      mesh->vertices.push_back(p);
      return at->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : mesh->triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh->triangles = std::move(finer);
    for (Vec3& p : mesh->vertices) {
      const double size = std::hypot(p[0], p[1], p[2]);
      for (double& value : p) value /= size;
    }
  }
  for (Vec3& p : mesh->vertices)
    for (double& value : p) value *= radius;
  return mesh;
}

// Two discs of `rings` rings of radius 1 in the planes z = ±half, whose rims loose edges join.
inline std::shared_ptr<TriangleMesh> made_up_cushion(int rings, double half) {
  auto mesh = std::make_shared<TriangleMesh>();
  const auto number = [](int ring, int k) {
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + k % (6 * ring);
  };
  const int count = 1 + 3 * rings * (rings + 1);
  for (const double z : {half, -half}) {
    const int first = int(mesh->vertices.size());
    mesh->vertices.push_back({0, 0, z});
    for (int ring = 1; ring <= rings; ++ring)
      for (int k = 0; k < 6 * ring; ++k) {
        const double angle = M_PI / 3 * k / ring, r = double(ring) / rings;
        mesh->vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
      }
    const auto add = [&](int a, int b, int c) {
      if (z < 0) std::swap(b, c);
      mesh->triangles.push_back({first + a, first + b, first + c});
    };
    for (int ring = 1; ring <= rings; ++ring)
      for (int sector = 0; sector < 6; ++sector)
        for (int k = 0; k < ring; ++k) {
          const int out = sector * ring + k, within = sector * (ring - 1) + k;
          const int a = number(ring, out), b = number(ring, out + 1);
          const int c = number(ring - 1, within);
          add(c, a, b);
          if (k + 1 < ring) add(c, b, number(ring - 1, within + 1));
        }
  }
  for (int k = 0; k < 6 * rings; ++k)
    mesh->edges.push_back({number(rings, k), count + number(rings, k)});
  return mesh;
}

// Of stiffness C11 [N/m], with a coupling of 0.3 of it.
inline Membrane alike_in_all_directions(double stiffness) {
  return {stiffness, stiffness, 0.3 * stiffness, 0.35 * stiffness, 0};
}

// Of a ball about zero [m].
inline double mean_radius(const Simulation& run) {
  const std::vector<double> x = run.positions();
  double sum = 0;
  for (std::size_t p = 0; p < x.size(); p += 3) sum += std::hypot(x[p], x[p + 1], x[p + 2]);
  return sum / (double(x.size()) / 3);
}

// What triangles enclose, in double precision [m³].
inline double enclosed(const std::vector<double>& x, const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const double *a = &x[3 * std::size_t(i)], *b = &x[3 * std::size_t(j)],
                 *c = &x[3 * std::size_t(k)];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

}  // namespace weft
