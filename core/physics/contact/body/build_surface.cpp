// How the surface of a body is made ready (body_surface.h).
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/contact/body/body_surface.h"

namespace weft {

using namespace physics;

namespace {

// The side of a triangle from corner k on.
struct Side {
  int low, high;  // vertices
  int triangle, k;
  bool upward;
};

std::vector<Side> sides_of(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[t][std::size_t(k)], b = triangles[t][std::size_t((k + 1) % 3)];
      sides.push_back({std::min(a, b), std::max(a, b), int(t), k, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

Vec3 unit(const Vec3& a) {
  return times(a, 1 / std::max(std::sqrt(dot(a, a)), 1e-300));
}

// Of two unit vectors [rad], by operations that have the same bits everywhere: halved three times, then by
// the series of the arc tangent, to 1e-11.
double angle_between(const Vec3& u, const Vec3& v) {
  const Vec3 apart = minus(u, v), together = plus(u, v);
  const double y = std::sqrt(dot(apart, apart)), x = std::sqrt(dot(together, together));
  double t = y / (x + std::sqrt(x * x + y * y));
  for (int n = 0; n < 2; ++n) t = t / (1 + std::sqrt(1 + t * t));
  const double s = t * t;
  double sum = 0;
  for (int n = 15; n > 0; n -= 2) sum = 1.0 / n - s * sum;
  return 16 * t * sum;
}

// Sets that are joined two by two (union-find).
class Joined {
 public:
  explicit Joined(std::size_t count) : to_(count) {
    for (std::size_t n = 0; n < count; ++n) to_[n] = int(n);
  }
  // The least of its set.
  int of(int n) {
    while (to_[std::size_t(n)] != n)
      n = to_[std::size_t(n)] = to_[std::size_t(to_[std::size_t(n)])];
    return n;
  }
  void join(int a, int b) {
    a = of(a), b = of(b);
    to_[std::size_t(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> to_;
};

}  // namespace

BodySurface::BodySurface(const TriangleMesh& mesh, std::vector<Vec3> vertices)
    : vertices_(std::move(vertices)), triangles_(mesh.triangles) {
  sort_into_parts();
  look_outward();
  find_normals();
  plant();
  find_features();
}

// Neighbours over edges, the parts that they make, and vertices of which each has one fan of triangles: where
// two fans meet in a point, that is two vertices.
void BodySurface::sort_into_parts() {
  const auto count = triangles_.size();
  std::vector<std::array<int, 3>> beside(count, {-1, -1, -1});
  Joined parts(count), corners(3 * count);
  const std::vector<Side> sides = sides_of(triangles_);
  for (std::size_t n = 0; n < sides.size();) {
    std::size_t end = n + 1;
    while (end < sides.size() && sides[end].low == sides[n].low && sides[end].high == sides[n].high)
      ++end;
    const Side &a = sides[n], &b = sides[end - 1];
    if (end == n + 2 && a.upward != b.upward) {
      beside[std::size_t(a.triangle)][std::size_t(a.k)] = b.triangle;
      beside[std::size_t(b.triangle)][std::size_t(b.k)] = a.triangle;
      parts.join(a.triangle, b.triangle);
      corners.join(3 * a.triangle + a.k, 3 * b.triangle + (b.k + 1) % 3);
      corners.join(3 * a.triangle + (a.k + 1) % 3, 3 * b.triangle + b.k);
    } else {
      open_edges_.push_back({a.low, a.high});
    }
    n = end;
  }
  std::vector<int> order(count), place(count);
  for (std::size_t t = 0; t < count; ++t) order[t] = int(t);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(parts.of(a), a) < std::pair(parts.of(b), b); });
  for (std::size_t n = 0; n < count; ++n) place[std::size_t(order[n])] = int(n);
  std::vector<int> vertex_of(3 * count, -1);  // of the least corner of a fan
  std::vector<Vec3> split;
  std::vector<std::array<int, 3>> sorted(count);
  beside_.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    const auto t = std::size_t(order[n]);
    if (n == 0 || parts.of(order[n]) != parts.of(order[n - 1])) {
      if (n > 0) parts_.back().last = int(n);
      parts_.push_back({int(n), int(count), {}});
    }
    for (std::size_t k = 0; k < 3; ++k) {
      int& vertex = vertex_of[std::size_t(corners.of(int(3 * t + k)))];
      if (vertex < 0) {
        vertex = int(split.size());
        split.push_back(vertices_[std::size_t(triangles_[t][k])]);
      }
      sorted[n][k] = vertex;
      beside_[n][k] = beside[t][k] < 0 ? -1 : place[std::size_t(beside[t][k])];
    }
  }
  vertices_ = std::move(split);
  triangles_ = std::move(sorted);
}

// Parts of a closed body whose triangles look inward are turned over.
void BodySurface::look_outward() {
  if (!closed()) return;
  for (const Part& part : parts_) {
    const Vec3 about = vertices_[std::size_t(triangles_[std::size_t(part.first)][0])];
    double volume = 0;
    for (int t = part.first; t < part.last; ++t) {
      const Triangle c = corners(t);
      volume += dot(minus(c[0], about), cross(minus(c[1], about), minus(c[2], about)));
    }
    for (int t = part.first; t < part.last && volume < 0; ++t) {
      std::swap(triangles_[std::size_t(t)][1], triangles_[std::size_t(t)][2]);
      std::swap(beside_[std::size_t(t)][0], beside_[std::size_t(t)][2]);
    }
  }
}

// Vertices weigh the normals about them by the triangles' angles there.
void BodySurface::find_normals() {
  vertex_normals_.assign(vertices_.size(), Vec3{});
  face_normals_.reserve(triangles_.size());
  first_at_.assign(vertices_.size() + 1, 0);
  double edges = 0;
  for (std::size_t n = 0; n < triangles_.size(); ++n) {
    const Triangle t = corners(int(n));
    const Vec3 normal = unit(normal_of(t[0], t[1], t[2]));
    face_normals_.push_back(normal);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 on = minus(t[(k + 1) % 3], t[k]), back = minus(t[(k + 2) % 3], t[k]);
      const auto vertex = std::size_t(triangles_[n][k]);
      vertex_normals_[vertex] =
          plus(vertex_normals_[vertex], times(normal, angle_between(unit(on), unit(back))));
      edges += std::sqrt(dot(on, on));
      ++first_at_[vertex + 1];
    }
  }
  for (Vec3& normal : vertex_normals_) normal = unit(normal);
  mean_edge_ = edges / double(3 * triangles_.size());
  for (std::size_t v = 0; v < vertices_.size(); ++v) first_at_[v + 1] += first_at_[v];
  std::vector<int> next(first_at_.begin(), first_at_.end() - 1);
  at_.resize(3 * triangles_.size());
  for (std::size_t n = 0; n < triangles_.size(); ++n)
    for (const int vertex : triangles_[n]) at_[std::size_t(next[std::size_t(vertex)]++)] = int(n);
}

void BodySurface::plant() {
  for (Part& part : parts_) {
    std::vector<AlignedBox> boxes;
    for (int t = part.first; t < part.last; ++t) {
      AlignedBox& box = boxes.emplace_back();
      for (const Vec3& corner : corners(t)) box.add(corner);
    }
    part.tree = BoxTree(boxes);
    bounds_.add(part.tree.bounds());
  }
}

// An edge bends by an angle over a third of the heights beside it: so far the middles of its triangles are
// from it. One that bends by more than kSharp is no approximation of something round; neither is a corner
// that much of a full turn is missing at. What bends inward does not stick out; a surface without an inside
// has no inward, and all of its border sticks out.
void BodySurface::find_features() {
  constexpr double kSharp = 0.35, kSharpCorner = 0.38, kFlat = 1e-4;  // rad
  std::vector<double> turns(vertices_.size(), 2 * std::numbers::pi);
  std::vector<double> radii(vertices_.size(), std::numeric_limits<double>::infinity());
  const auto height = [&](int triangle, std::size_t k) {
    const Triangle t = corners(triangle);
    const Vec3 side = minus(t[(k + 1) % 3], t[k]), n = cross(side, minus(t[(k + 2) % 3], t[k]));
    return std::sqrt(dot(n, n) / dot(side, side));
  };
  for (std::size_t n = 0; n < triangles_.size(); ++n) {
    const Triangle t = corners(int(n));
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = triangles_[n][k], b = triangles_[n][(k + 1) % 3], other = beside_[n][k];
      turns[std::size_t(a)] -=
          angle_between(unit(minus(t[(k + 1) % 3], t[k])), unit(minus(t[(k + 2) % 3], t[k])));
      if (other >= 0 && other < int(n)) continue;
      Feature edge{a, b, face_normals_[n], 0, int(n)};
      if (other >= 0) {
        const auto o = std::size_t(other);
        const auto across = std::size_t(std::find(beside_[o].begin(), beside_[o].end(), int(n)) -
                                        beside_[o].begin());
        const Vec3& tip = vertices_[std::size_t(triangles_[o][(across + 2) % 3])];
        const double angle = angle_between(face_normals_[n], face_normals_[o]);
        const bool inward = dot(minus(tip, t[k]), face_normals_[n]) > 0;
        if (angle < kFlat || (inward && closed())) continue;
        edge.normal = unit(plus(face_normals_[n], face_normals_[o]));
        edge.radius =
            angle > kSharp ? 0 : (height(int(n), k) + height(other, across)) / (3 * angle);
      }
      for (const int v : {a, b})
        radii[std::size_t(v)] = std::min(radii[std::size_t(v)], edge.radius);
      features_.push_back(edge);
    }
  }
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (std::isinf(radii[v])) continue;
    const bool sharp = closed() && turns[v] > kSharpCorner;
    features_.push_back(
        {int(v), int(v), vertex_normals_[v], sharp ? 0 : radii[v], at_vertex(int(v)).front()});
  }
  std::vector<AlignedBox> boxes;
  std::vector<double> of_features;
  least_radius_ = std::numeric_limits<double>::infinity();
  for (const Feature& f : features_) {
    AlignedBox& box = boxes.emplace_back();
    box.add(vertices_[std::size_t(f.a)]);
    box.add(vertices_[std::size_t(f.b)]);
    of_features.push_back(f.radius);
    least_radius_ = std::min(least_radius_, f.radius);
  }
  feature_tree_ = BoxTree(boxes);
  least_radii_ = feature_tree_.least_of(of_features);
}

}  // namespace weft
