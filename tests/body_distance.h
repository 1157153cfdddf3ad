// How deep a sheet's triangles lie in bodies: double precision, by the definitions of the shapes alone,
// nothing of the library's own geometry.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "weft/mesh.h"

namespace weft::tests {

inline Vec3 difference(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline double product(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double length(const Vec3& a) {
  return std::sqrt(product(a, a));
}

inline double distance_from(const Sphere& s, const Vec3& p) {
  return length(difference(p, s.center)) - s.radius;
}
inline double distance_from(const Plane& s, const Vec3& p) {
  return product(difference(p, s.point), s.normal) / length(s.normal);
}
inline double distance_from(const Capsule& s, const Vec3& p) {
  const Vec3 e = difference(s.b, s.a), d = difference(p, s.a);
  const double t = std::clamp(product(d, e) / product(e, e), 0.0, 1.0);
  return length({d[0] - t * e[0], d[1] - t * e[1], d[2] - t * e[2]}) - s.radius;
}
// The least over all balls between the two: a convex function of where the ball is, whose least is searched for.
inline double distance_from(const TaperedCapsule& s, const Vec3& p) {
  const Vec3 e = difference(s.b, s.a), d = difference(p, s.a);
  const auto from_ball = [&](double t) {
    return length({d[0] - t * e[0], d[1] - t * e[1], d[2] - t * e[2]}) - s.radius_a -
           t * (s.radius_b - s.radius_a);
  };
  double low = 0, high = 1;
  for (int n = 0; n < 80; ++n) {
    const double third = (high - low) / 3;
    if (from_ball(low + third) < from_ball(high - third))
      high -= third;
    else
      low += third;
  }
  return std::min({from_ball(0), from_ball(1), from_ball(low)});
}
inline double distance_from(const Cylinder& s, const Vec3& p) {
  const Vec3 e = difference(s.b, s.a), d = difference(p, s.a);
  const double size = length(e), z = product(d, e) / size;
  const double across = std::sqrt(std::max(0.0, product(d, d) - z * z)) - (s.radius - s.rounding);
  const double along = std::abs(z - size / 2) - (size / 2 - s.rounding);
  return std::hypot(std::max(across, 0.0), std::max(along, 0.0)) +
         std::min(std::max(across, along), 0.0) - s.rounding;
}
inline double distance_from(const Box& s, const Vec3& p) {
  Vec3 q = difference(p, s.center);
  // Turned back: about z, then y, then x.
  for (int k = 2; k >= 0; --k) {
    const double angle = -s.rotation[k] * std::numbers::pi / 180;
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const double qa = q[a], qb = q[b];
    q[a] = std::cos(angle) * qa - std::sin(angle) * qb;
    q[b] = std::sin(angle) * qa + std::cos(angle) * qb;
  }
  Vec3 out;
  double most = -1e300;
  for (int k = 0; k < 3; ++k) {
    const double over = std::abs(q[k]) - (s.half[k] - s.rounding);
    out[k] = std::max(over, 0.0);
    most = std::max(most, over);
  }
  return length(out) + std::min(most, 0.0) - s.rounding;
}

inline Vec3 product_of(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double from_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 e = difference(b, a), d = difference(p, a);
  const double t = std::clamp(product(d, e) / product(e, e), 0.0, 1.0);
  return length({d[0] - t * e[0], d[1] - t * e[1], d[2] - t * e[2]});
}

// Of a point from a triangle: from its plane where it is above it, else from its sides.
inline double from_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 n = product_of(difference(t[1], t[0]), difference(t[2], t[0]));
  bool above = true;
  double least = 1e300;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = t[k], &b = t[(k + 1) % 3];
    above = above && product(product_of(difference(b, a), difference(p, a)), n) > 0;
    least = std::min(least, from_segment(p, a, b));
  }
  return above ? std::abs(product(difference(p, t[0]), n)) / length(n) : least;
}

inline std::array<Vec3, 3> triangle_of(const TriangleMesh& mesh, std::size_t n) {
  std::array<Vec3, 3> t;
  for (std::size_t k = 0; k < 3; ++k) t[k] = mesh.vertices[std::size_t(mesh.triangles[n][k])];
  return t;
}

inline double from_mesh(const TriangleMesh& mesh, const Vec3& p) {
  double least = 1e300;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n)
    least = std::min(least, from_triangle(p, triangle_of(mesh, n)));
  return least;
}

// How often the triangles go around a point, by the solid angles under which it sees them (Van Oosterom and
// Strackee 1983).
inline double turns_about(const TriangleMesh& mesh, const Vec3& p) {
  double sum = 0;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const auto t = triangle_of(mesh, n);
    const Vec3 a = difference(t[0], p), b = difference(t[1], p), c = difference(t[2], p);
    const double la = length(a), lb = length(b), lc = length(c);
    sum +=
        2 * std::atan2(product(a, product_of(b, c)),
                       la * lb * lc + product(a, b) * lc + product(b, c) * la + product(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

// Negative where the triangles go around the point.
inline double distance_from(const MeshBody& body, const Vec3& p) {
  const TriangleMesh placed{placed_vertices(body), body.shape->triangles, {}, {}, {}};
  return std::abs(turns_about(placed, p)) > 0.5 ? -from_mesh(placed, p) : from_mesh(placed, p);
}

// The least distance of a point of the triangle from the shape. That of a convex shape is a convex
// function, so that nested golden sections find it.
template <class Distance>
double least_on_triangle(const std::array<Vec3, 3>& t, const Distance& distance) {
  constexpr int kCuts = 40;
  constexpr double kGolden = 0.6180339887498949;
  const auto least = [](const auto& f) {
    double low = 0, high = 1;
    for (int n = 0; n < kCuts; ++n) {
      const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
      if (f(a) < f(b))
        high = b;
      else
        low = a;
    }
    return std::min({f(0.0), f(1.0), f((low + high) / 2)});
  };
  return least([&](double u) {
    return least([&](double v) {
      Vec3 p;
      for (int k = 0; k < 3; ++k) {
        const double along = t[1][k] + v * (t[2][k] - t[1][k]);
        p[k] = t[0][k] + u * (along - t[0][k]);
      }
      return distance(p);
    });
  });
}

// How deep the deepest point of a grid's triangles is below the surface of a collider that stands `by`
// off where the scene has it [m]; negative where all are above it. The squares are split from (i+1, j) to
// (i, j+1). `x`: three components of each of nx * ny particles.
inline double deepest_triangle(std::span<const double> x, int nx, int ny, const Collider& collider,
                               const Vec3& by = {}) {
  const auto at = [&](int i, int j) {
    const std::size_t n = 3 * (std::size_t(j) * nx + i);
    return Vec3{x[n] - by[0], x[n + 1] - by[1], x[n + 2] - by[2]};
  };
  double least = 1e300;
  const auto look = [&](const std::array<Vec3, 3>& t) {
    const auto distance = [&](const Vec3& p) {
      return std::visit([&](const auto& shape) { return distance_from(shape, p); }, collider.shape);
    };
    double nearest = 1e300, longest = 0;
    for (int k = 0; k < 3; ++k) {
      nearest = std::min(nearest, distance(t[k]));
      longest = std::max(longest, length(difference(t[k], t[(k + 1) % 3])));
    }
    if (nearest - longest < least)
      least = std::min({least, nearest, least_on_triangle(t, distance)});
  };
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + 1 < nx; ++i) {
      look({at(i, j), at(i + 1, j), at(i, j + 1)});
      look({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return -least;
}

}  // namespace weft::tests
