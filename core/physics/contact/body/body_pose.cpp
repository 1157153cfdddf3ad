#include "physics/contact/body/body_pose.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace weft::physics {
namespace {

// How much of a full turn is missing at a vertex [rad].
double deficit(const BodyForm& form, int vertex, const std::vector<Vec3>& x) {
  double left = 2 * std::numbers::pi;
  for (const int n : form.at_vertex(vertex)) {
    const auto& t = form.triangles[std::size_t(n)];
    const std::size_t k = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
    const Vec3& own = x[std::size_t(vertex)];
    left -= angle_between(unit(minus(x[std::size_t(t[(k + 1) % 3])], own)),
                          unit(minus(x[std::size_t(t[(k + 2) % 3])], own)));
  }
  return left;
}

// The angle of two unit vectors that are nearly alike, by their distance [rad]; to 1e-3 below half a turn.
double small_angle(const Vec3& u, const Vec3& v) {
  const Vec3 d = minus(u, v);
  const double square = dot(d, d);
  return std::sqrt(square) * (1 + square / 24 + 3 * square * square / 640);
}

// An edge bends by an angle over a third of the heights beside it: so far the middles of its triangles are
// from it. One that bends by more than kSharp is no approximation of something round; neither is a corner
// that much of a full turn is missing at. What bends inward does not stick out; a surface without an inside
// has no inward, and all of its border sticks out.
std::vector<double> radii_of(const BodyForm& form, const std::vector<Vec3>& x,
                             const std::vector<Vec3>& face_normals) {
  constexpr double kSharp = 0.35, kSharpCorner = 0.38, kFlat = 1e-4;  // rad
  constexpr double kHardly = 1;  // rad, of all edges: where they bend less, no corner is sharp
  const double infinite = std::numeric_limits<double>::infinity();
  std::vector<double> radii, at_corners(x.size(), infinite), bends(x.size());
  radii.reserve(form.features.size());
  for (const BodyForm::Feature& f : form.features) {
    if (f.a == f.b) {
      const auto v = std::size_t(f.a);
      const bool sharp = form.closed() && bends[v] > kHardly && at_corners[v] < infinite &&
                         deficit(form, f.a, x) > kSharpCorner;
      radii.push_back(sharp ? 0 : at_corners[v]);
      continue;
    }
    const Vec3 &a = x[std::size_t(f.a)], &b = x[std::size_t(f.b)];
    double radius = 0;
    if (f.other >= 0) {
      const auto tip = [&](int triangle) -> const Vec3& {
        for (const int v : form.triangles[std::size_t(triangle)])
          if (v != f.a && v != f.b) return x[std::size_t(v)];
        return a;
      };
      const Vec3 &n = face_normals[std::size_t(f.triangle)],
                 &m = face_normals[std::size_t(f.other)], side = minus(b, a);
      const Vec3 &near = tip(f.triangle), &far = tip(f.other);
      const double angle = small_angle(n, m);
      const bool inward = form.closed() && dot(minus(far, a), n) > 0;
      const Vec3 one = cross(side, minus(near, a)), two = cross(side, minus(far, a));
      const double heights =
          (length(one) + length(two)) / std::sqrt(std::max(dot(side, side), 1e-300));
      radius = angle < kFlat || inward ? infinite : angle > kSharp ? 0 : heights / (3 * angle);
      if (!inward)
        for (const int v : {f.a, f.b}) bends[std::size_t(v)] += angle;
    }
    for (const int v : {f.a, f.b})
      at_corners[std::size_t(v)] = std::min(at_corners[std::size_t(v)], radius);
    radii.push_back(radius);
  }
  return radii;
}

std::vector<Vec3> face_normals_of(const BodyForm& form, const std::vector<Vec3>& x) {
  std::vector<Vec3> normals;
  normals.reserve(form.triangles.size());
  for (const auto& [a, b, c] : form.triangles)
    normals.push_back(unit(normal_of(x[std::size_t(a)], x[std::size_t(b)], x[std::size_t(c)])));
  return normals;
}

}  // namespace

double least_radius_of(const BodyForm& form, const std::vector<Vec3>& vertices) {
  double least = std::numeric_limits<double>::infinity();
  for (const double radius : radii_of(form, vertices, face_normals_of(form, vertices)))
    least = std::min(least, radius);
  return least;
}

// Halved three times, then by the series of the arc tangent.
double angle_between(const Vec3& u, const Vec3& v) {
  const Vec3 apart = minus(u, v), together = plus(u, v);
  const double y = length(apart), x = length(together);
  double t = y / (x + std::sqrt(x * x + y * y));
  for (int n = 0; n < 2; ++n) t = t / (1 + std::sqrt(1 + t * t));
  const double s = t * t;
  double sum = 0;
  for (int n = 15; n > 0; n -= 2) sum = 1.0 / n - s * sum;
  return 16 * t * sum;
}

BodyPose::BodyPose(const BodyForm& form, std::vector<Vec3> at)
    : vertices(std::move(at)), face_normals(face_normals_of(form, vertices)) {
  const auto corner = [&](int vertex) -> const Vec3& { return vertices[std::size_t(vertex)]; };
  for (const BodyForm::Part& part : form.parts) {
    boxes.push_back(part.tree.refitted([&](int n) {
      AlignedBox box;
      for (const int v : form.triangles[std::size_t(part.first + n)]) box.add(corner(v));
      return box;
    }));
    bounds.add(boxes.back()[0]);
  }
  feature_boxes = form.feature_tree.refitted([&](int n) {
    AlignedBox box;
    box.add(corner(form.features[std::size_t(n)].a));
    box.add(corner(form.features[std::size_t(n)].b));
    return box;
  });
  radii = radii_of(form, vertices, face_normals);
  least_radii = form.feature_tree.least_of(radii);
}

std::size_t BodyPose::bytes() const {
  std::size_t bytes =
      (vertices.size() + face_normals.size() + vertex_normals.size()) * sizeof(Vec3) +
      feature_boxes.size() * sizeof(AlignedBox) +
      (radii.size() + least_radii.size()) * sizeof(double);
  for (const auto& part : boxes) bytes += part.size() * sizeof(AlignedBox);
  return bytes;
}

}  // namespace weft::physics
