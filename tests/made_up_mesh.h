// Meshes that tests make: a rectangle of points, shifted at random, with diagonals at random.
#pragma once

#include <cmath>
#include <memory>
#include <random>

#include "weft/mesh.h"

namespace weft {

enum class Diagonals { alike, crossed, random };

struct MadeUpMesh {
  int nx = 9, ny = 9;
  double width = 1, height = 1;  // m, along x and z
  double shift = 0;              // of inner points, of the spacing; on the border along it
  Diagonals diagonals = Diagonals::random;
  bool shuffled = false;  // vertices in any order
  unsigned seed = 1;
};

// In the plane y = 0, row after row unless it is shuffled; corners stay where they are, and so does the
// row at x = 0 and the next.
inline std::shared_ptr<TriangleMesh> made_up(const MadeUpMesh& m) {
  std::mt19937 random(m.seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (double(random()) / 4294967296.0);
  };
  auto mesh = std::make_shared<TriangleMesh>();
  const int count = m.nx * m.ny;
  std::vector<int> place(std::size_t(count), 0);
  for (int n = 0; n < count; ++n) place[std::size_t(n)] = n;
  if (m.shuffled)
    for (int n = count - 1; n > 0; --n)
      std::swap(place[std::size_t(n)], place[std::size_t(random() % unsigned(n + 1))]);
  mesh->vertices.resize(std::size_t(count));
  for (int j = 0; j < m.ny; ++j)
    for (int i = 0; i < m.nx; ++i) {
      const double dx = i > 1 && i < m.nx - 1 ? between(-m.shift, m.shift) : 0;
      const double dy = j > 0 && j < m.ny - 1 ? between(-m.shift, m.shift) : 0;
      mesh->vertices[std::size_t(place[std::size_t(j * m.nx + i)])] = {
          m.width * (i + dx) / (m.nx - 1), 0, m.height * (j + dy) / (m.ny - 1)};
    }
  for (int j = 0; j + 1 < m.ny; ++j)
    for (int i = 0; i + 1 < m.nx; ++i) {
      const auto at = [&](int a, int b) { return place[std::size_t((j + b) * m.nx + i + a)]; };
      const int a = at(0, 0), b = at(1, 0), c = at(0, 1), d = at(1, 1);
      const bool one = m.diagonals == Diagonals::alike     ? true
                       : m.diagonals == Diagonals::crossed ? (i + j) % 2 == 0
                                                           : random() % 2 == 0;
      if (one) {
        mesh->triangles.push_back({a, c, b});
        mesh->triangles.push_back({b, c, d});
      } else {
        mesh->triangles.push_back({a, d, b});
        mesh->triangles.push_back({a, c, d});
      }
    }
  return mesh;
}

// The vertex nearest to a place.
inline int nearest_vertex(const TriangleMesh& mesh, const Vec3& at) {
  int best = 0;
  double least = 1e300;
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
    const Vec3& v = mesh.vertices[n];
    const double d = std::hypot(v[0] - at[0], v[1] - at[1], v[2] - at[2]);
    if (d < least) least = d, best = int(n);
  }
  return best;
}

}  // namespace weft
