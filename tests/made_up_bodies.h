// Bodies of triangles that tests make, and what a body is asked, by brute force: nothing of the library's own
// geometry.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "body_distance.h"
#include "weft/mesh.h"

namespace weft::tests {

// A closed grid of points around and along: a torus where it also closes along, else with a pole at both ends.
inline std::shared_ptr<TriangleMesh> revolved(
    int around, int along, bool torus, const std::function<Vec3(double around, double along)>& at) {
  auto mesh = std::make_shared<TriangleMesh>();
  const int first = torus ? 0 : 1, rows = torus ? along : along - 1;
  if (!torus) mesh->vertices.push_back(at(0, 0));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < around; ++i)
      mesh->vertices.push_back(at(double(i) / around, double(j + first) / along));
  const auto number = [&](int i, int j) { return first + (j % rows) * around + i % around; };
  for (int j = 0; j + (torus ? 0 : 1) < rows; ++j)
    for (int i = 0; i < around; ++i) {
      const int a = number(i, j), b = number(i + 1, j), c = number(i, j + 1),
                d = number(i + 1, j + 1);
      mesh->triangles.push_back({a, c, b});
      mesh->triangles.push_back({b, c, d});
    }
  if (torus) return mesh;
  const int last = int(mesh->vertices.size());
  mesh->vertices.push_back(at(0, 1));
  for (int i = 0; i < around; ++i) {
    mesh->triangles.push_back({0, number(i, 0), number(i + 1, 0)});
    mesh->triangles.push_back({last, number(i + 1, rows - 1), number(i, rows - 1)});
  }
  return mesh;
}

// About zero, pole up; `radius`(azimuth, polar angle).
inline std::shared_ptr<TriangleMesh> ball(int around, int along,
                                          const std::function<double(double, double)>& radius) {
  return revolved(around, along, false, [&](double u, double v) {
    const double a = -2 * std::numbers::pi * u, p = std::numbers::pi * v, r = radius(a, p);
    return Vec3{r * std::sin(p) * std::cos(a), r * std::cos(p), r * std::sin(p) * std::sin(a)};
  });
}

inline std::shared_ptr<TriangleMesh> ball(int around, int along, double radius) {
  return ball(around, along, [=](double, double) { return radius; });
}

// Lying level about zero.
inline std::shared_ptr<TriangleMesh> torus(int around, int along, double large, double small) {
  return revolved(around, along, true, [=](double u, double v) {
    const double a = -2 * std::numbers::pi * u, b = 2 * std::numbers::pi * v;
    const double r = large + small * std::sin(b);
    return Vec3{r * std::cos(a), small * std::cos(b), r * std::sin(a)};
  });
}

inline std::shared_ptr<TriangleMesh> box(const Vec3& half) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int n = 0; n < 8; ++n)
    mesh->vertices.push_back(
        {(n & 1 ? 1 : -1) * half[0], (n & 2 ? 1 : -1) * half[1], (n & 4 ? 1 : -1) * half[2]});
  for (const auto& [a, b, c, d] : {std::array{0, 4, 6, 2},
                                   {1, 3, 7, 5},
                                   {0, 1, 5, 4},
                                   {2, 6, 7, 3},
                                   {0, 2, 3, 1},
                                   {4, 5, 7, 6}}) {
    mesh->triangles.push_back({a, b, c});
    mesh->triangles.push_back({a, c, d});
  }
  return mesh;
}

// The lower half of a ball, open upward.
inline std::shared_ptr<TriangleMesh> bowl(int around, int along, double radius) {
  auto mesh = ball(around, 2 * along, radius);
  std::erase_if(mesh->triangles, [&](const auto& t) {
    double top = -1e300;
    for (const int p : t) top = std::max(top, mesh->vertices[std::size_t(p)][1]);
    return top > 1e-9;
  });
  return mesh;
}

// Two bodies in one file.
inline std::shared_ptr<TriangleMesh> together(const TriangleMesh& a, const TriangleMesh& b,
                                              const Vec3& by) {
  auto both = std::make_shared<TriangleMesh>(a);
  const int first = int(a.vertices.size());
  for (const Vec3& p : b.vertices)
    both->vertices.push_back({p[0] + by[0], p[1] + by[1], p[2] + by[2]});
  for (const auto& t : b.triangles)
    both->triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return both;
}

inline Collider body_of(std::shared_ptr<const TriangleMesh> mesh, double friction = 0) {
  Collider c;
  MeshBody body;
  body.shape = std::move(mesh);
  body.surface = surface_of(body);
  c.shape = body;
  c.friction = {FrictionModel::coulomb, friction, friction};
  return c;
}

// Whether a segment passes through a triangle, by the signs of volumes.
inline bool passes(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return product(product_of(difference(b, a), difference(c, a)), difference(d, a));
  };
  if (volume(t[0], t[1], t[2], p) * volume(t[0], t[1], t[2], q) >= 0) return false;
  const double u = volume(p, q, t[0], t[1]), v = volume(p, q, t[1], t[2]),
               w = volume(p, q, t[2], t[0]);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

// How many edges of either pass through a triangle of the other.
inline int crossings(const TriangleMesh& a, const TriangleMesh& b) {
  int count = 0;
  const auto through = [&](const TriangleMesh& edges, const TriangleMesh& faces) {
    for (std::size_t n = 0; n < faces.triangles.size(); ++n) {
      const auto t = triangle_of(faces, n);
      Vec3 low = t[0], high = t[0];
      for (const Vec3& c : t)
        for (std::size_t k = 0; k < 3; ++k)
          low[k] = std::min(low[k], c[k]), high[k] = std::max(high[k], c[k]);
      for (const auto& e : edges.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3 &p = edges.vertices[std::size_t(e[k])],
                     &q = edges.vertices[std::size_t(e[(k + 1) % 3])];
          bool apart = e[k] > e[(k + 1) % 3];  // each edge once, where it has two triangles
          for (std::size_t m = 0; m < 3; ++m)
            apart = apart || std::max(p[m], q[m]) < low[m] || std::min(p[m], q[m]) > high[m];
          count += !apart && passes(p, q, t);
        }
    }
  };
  through(a, b);
  through(b, a);
  return count;
}

// A grid's particles as a mesh, squares split as the library splits them.
inline TriangleMesh as_mesh(std::span<const double> x, int nx, int ny) {
  TriangleMesh mesh;
  for (int n = 0; n < nx * ny; ++n)
    mesh.vertices.push_back(
        {x[std::size_t(3 * n)], x[std::size_t(3 * n + 1)], x[std::size_t(3 * n + 2)]});
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + 1 < nx; ++i) {
      const int a = j * nx + i;
      mesh.triangles.push_back({a, a + 1, a + nx});
      mesh.triangles.push_back({a + 1, a + nx + 1, a + nx});
    }
  return mesh;
}

}  // namespace weft::tests
