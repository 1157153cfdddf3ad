// How the form of a body is found (body_form.h).
#include "physics/contact/body/body_form.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace weft::physics {
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

BodyForm::BodyForm(const TriangleMesh& mesh, const std::vector<Vec3>& vertices) {
  sort_into_parts(mesh);
  const std::vector<Vec3> x = split(vertices);
  look_outward(x);
  list_corners(x);
  plant(x);
}

std::vector<Vec3> BodyForm::split(const std::vector<Vec3>& vertices) const {
  std::vector<Vec3> x;
  x.reserve(of_file.size());
  for (const int vertex : of_file) x.push_back(vertices[std::size_t(vertex)]);
  return x;
}

std::size_t BodyForm::bytes() const {
  std::size_t bytes = triangles.size() * sizeof(triangles[0]) * 2 +
                      (of_file.size() * 2 + at.size()) * sizeof(int) +
                      features.size() * sizeof(Feature) + feature_tree.bytes();
  for (const Part& part : parts) bytes += part.tree.bytes();
  return bytes;
}

// Neighbours over edges, the parts that they make, and vertices of which each has one fan of triangles: where
// two fans meet in a point, that is two vertices.
void BodyForm::sort_into_parts(const TriangleMesh& mesh) {
  const auto count = mesh.triangles.size();
  std::vector<std::array<int, 3>> across(count, {-1, -1, -1});
  Joined joined(count), corners(3 * count);
  const std::vector<Side> sides = sides_of(mesh.triangles);
  for (std::size_t n = 0; n < sides.size();) {
    std::size_t end = n + 1;
    while (end < sides.size() && sides[end].low == sides[n].low && sides[end].high == sides[n].high)
      ++end;
    const Side &a = sides[n], &b = sides[end - 1];
    if (end == n + 2 && a.upward != b.upward) {
      across[std::size_t(a.triangle)][std::size_t(a.k)] = b.triangle;
      across[std::size_t(b.triangle)][std::size_t(b.k)] = a.triangle;
      joined.join(a.triangle, b.triangle);
      corners.join(3 * a.triangle + a.k, 3 * b.triangle + (b.k + 1) % 3);
      corners.join(3 * a.triangle + (a.k + 1) % 3, 3 * b.triangle + b.k);
    } else {
      open_edges.push_back({a.low, a.high});
    }
    n = end;
  }
  std::vector<int> order(count), place(count);
  for (std::size_t t = 0; t < count; ++t) order[t] = int(t);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(joined.of(a), a) < std::pair(joined.of(b), b); });
  for (std::size_t n = 0; n < count; ++n) place[std::size_t(order[n])] = int(n);
  std::vector<int> vertex_of(3 * count, -1);  // of the least corner of a fan
  triangles.resize(count);
  beside.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    const auto t = std::size_t(order[n]);
    if (n == 0 || joined.of(order[n]) != joined.of(order[n - 1])) {
      if (n > 0) parts.back().last = int(n);
      parts.push_back({int(n), int(count), {}});
    }
    for (std::size_t k = 0; k < 3; ++k) {
      int& vertex = vertex_of[std::size_t(corners.of(int(3 * t + k)))];
      if (vertex < 0) {
        vertex = int(of_file.size());
        of_file.push_back(mesh.triangles[t][k]);
      }
      triangles[n][k] = vertex;
      beside[n][k] = across[t][k] < 0 ? -1 : place[std::size_t(across[t][k])];
    }
  }
}

// Parts of a closed body whose triangles look inward are turned over.
void BodyForm::look_outward(const std::vector<Vec3>& x) {
  if (!closed()) return;
  for (const Part& part : parts) {
    const Vec3 about = x[std::size_t(triangles[std::size_t(part.first)][0])];
    double volume = 0;
    for (int t = part.first; t < part.last; ++t) {
      const auto& [a, b, c] = triangles[std::size_t(t)];
      volume += dot(minus(x[std::size_t(a)], about),
                    cross(minus(x[std::size_t(b)], about), minus(x[std::size_t(c)], about)));
    }
    for (int t = part.first; t < part.last && volume < 0; ++t) {
      std::swap(triangles[std::size_t(t)][1], triangles[std::size_t(t)][2]);
      std::swap(beside[std::size_t(t)][0], beside[std::size_t(t)][2]);
    }
  }
}

void BodyForm::list_corners(const std::vector<Vec3>& x) {
  first_at.assign(of_file.size() + 1, 0);
  double edges = 0;
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 on = minus(x[std::size_t(t[(k + 1) % 3])], x[std::size_t(t[k])]);
      edges += length(on);
      ++first_at[std::size_t(t[k]) + 1];
    }
  mean_edge = edges / double(3 * triangles.size());
  for (std::size_t v = 0; v < of_file.size(); ++v) first_at[v + 1] += first_at[v];
  std::vector<int> next(first_at.begin(), first_at.end() - 1);
  at.resize(3 * triangles.size());
  for (std::size_t n = 0; n < triangles.size(); ++n)
    for (const int vertex : triangles[n]) at[std::size_t(next[std::size_t(vertex)]++)] = int(n);
}

// The trees, and the features: each edge once, by the first of its triangles, and all corners.
void BodyForm::plant(const std::vector<Vec3>& x) {
  std::vector<AlignedBox> boxes;
  for (Part& part : parts) {
    boxes.clear();
    for (int t = part.first; t < part.last; ++t) {
      AlignedBox& box = boxes.emplace_back();
      for (const int vertex : triangles[std::size_t(t)]) box.add(x[std::size_t(vertex)]);
    }
    part.tree = BoxTree(boxes);
  }
  for (std::size_t n = 0; n < triangles.size(); ++n)
    for (std::size_t k = 0; k < 3; ++k)
      if (const int other = beside[n][k]; other < 0 || other > int(n))
        features.push_back({triangles[n][k], triangles[n][(k + 1) % 3], int(n), other});
  for (std::size_t v = 0; v < of_file.size(); ++v)
    features.push_back({int(v), int(v), at_vertex(int(v)).front(), -1});
  boxes.clear();
  for (const Feature& f : features) {
    AlignedBox& box = boxes.emplace_back();
    box.add(x[std::size_t(f.a)]);
    box.add(x[std::size_t(f.b)]);
  }
  feature_tree = BoxTree(boxes);
}

}  // namespace weft::physics
