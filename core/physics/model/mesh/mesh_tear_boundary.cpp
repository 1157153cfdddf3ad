#include "physics/model/mesh/mesh_tear_boundary.h"

#include <algorithm>
#include <cmath>

#include "weft/vec3.h"

namespace weft::physics {
namespace {

// The whole triangle at a vertex that lies most nearly in a direction, -1: none; and its other two corners.
struct Beside {
  double cosine = -2;
  int a = -1, b = -1;
};
Beside beside(const MeshTearing& t, int vertex, const Vec3& way) {
  const std::vector<Vec3>& rest = t.parts().rest;
  const Vec3& own = rest[std::size_t(vertex)];
  Beside best;
  for (const int n : t.around(vertex)) {
    if (t.gone(std::size_t(n))) continue;
    const auto& corners = t.parts().mesh.triangles[std::size_t(n)];
    const auto at =
        std::size_t(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
    const int a = corners[(at + 1) % 3], b = corners[(at + 2) % 3];
    const Vec3 middle = minus(plus(rest[std::size_t(a)], rest[std::size_t(b)]), times(own, 2));
    const double cosine = dot(middle, way) / std::sqrt(dot(middle, middle) * dot(way, way));
    if (cosine > best.cosine) best = {cosine, a, b};
  }
  return best;
}

}  // namespace

void MeshTearBoundary::update(const MeshTearing& tearing) {
  if (version_ != tearing.version()) rebuild(tearing);
  version_ = tearing.version();
  const Rows& at = tearing.parts().particles.x;
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const Point& p = points_[n];
    for (int k = 0; k < 3; ++k) {
      const auto x = at.component(k);
      places_[n][std::size_t(k)] =
          x[p.vertex] + p.along_a * (x[p.a] - x[p.vertex]) + p.along_b * (x[p.b] - x[p.vertex]);
    }
  }
}

void MeshTearBoundary::rebuild(const MeshTearing& t) {
  points_.clear();
  owners_.clear();
  triangles_.clear();
  for (std::size_t n = 0; n < t.parts().mesh.triangles.size(); ++n)
    if (t.gone(n)) add_shares(t, n);
  places_.resize(points_.size());
}

void MeshTearBoundary::add_shares(const MeshTearing& t, std::size_t triangle) {
  const auto& corners = t.parts().mesh.triangles[triangle];
  const auto way = [&](int p, int q, double share) {
    const std::vector<Vec3>& rest = t.parts().rest;
    return times(minus(rest[std::size_t(q)], rest[std::size_t(p)]), share);
  };
  const auto own = [&](int p) { return point(t, p, Vec3{}); };
  const auto end = [&](int p, int q) { return point(t, p, way(p, q, 0.5)); };
  const auto middle = [&](int a, int b, int c) {
    return point(t, a, plus(way(a, b, 1 / 3.0), way(a, c, 1 / 3.0)));
  };
  share_torn_triangle(corners, t.gone(triangle), own, end, middle,
                      [&](const std::array<TornPoint, 3>& points) { add(points); });
}

TornPoint MeshTearBoundary::point(const MeshTearing& t, int vertex, const Vec3& way) {
  const auto lane = [&](int v) { return t.parts().drawn.lanes[std::size_t(v)]; };
  Point made{lane(vertex), lane(vertex), lane(vertex), 0, 0};
  if (way != Vec3{}) {
    const Beside whole = beside(t, vertex, way);
    if (whole.a < 0) return std::nullopt;
    const std::vector<Vec3>& rest = t.parts().rest;
    const Vec3& own = rest[std::size_t(vertex)];
    const Vec3 p = minus(rest[std::size_t(whole.a)], own),
               q = minus(rest[std::size_t(whole.b)], own);
    const double pp = dot(p, p), pq = dot(p, q), qq = dot(q, q);
    const double dp = dot(way, p), dq = dot(way, q), det = pp * qq - pq * pq;
    made.a = lane(whole.a), made.b = lane(whole.b);
    made.along_a = float((dp * qq - dq * pq) / det);
    made.along_b = float((dq * pp - dp * pq) / det);
  }
  points_.push_back(made);
  owners_.push_back(made.vertex);
  return std::uint32_t(points_.size() - 1);
}

void MeshTearBoundary::add(const std::array<TornPoint, 3>& c) {
  if (c[0] && c[1] && c[2]) triangles_.push_back({*c[0], *c[1], *c[2]});
}

std::size_t MeshTearBoundary::bytes() const {
  return points_.capacity() * sizeof(Point) + owners_.capacity() * 4 +
         places_.capacity() * sizeof(places_[0]) + triangles_.capacity() * sizeof(triangles_[0]);
}

}  // namespace weft::physics
