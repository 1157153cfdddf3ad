// Distances from the surface of a body that is a mesh (body_surface.h).
#include "physics/contact/body/body_surface.h"

#include <cassert>
#include <cmath>

namespace weft {

using namespace physics;

namespace {

constexpr double kTouching = 1e-10;  // m; nearer points have no direction of their own

double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}

}  // namespace

Triangle BodySurface::corners(int triangle) const {
  const auto& [a, b, c] = triangles_[std::size_t(triangle)];
  return {vertices_[std::size_t(a)], vertices_[std::size_t(b)], vertices_[std::size_t(c)]};
}

std::span<const int> BodySurface::at_vertex(int vertex) const {
  const auto begin = std::size_t(first_at_[std::size_t(vertex)]);
  return std::span(at_).subspan(begin, std::size_t(first_at_[std::size_t(vertex) + 1]) - begin);
}

std::size_t BodySurface::bytes() const {
  std::size_t bytes = vertices_.size() * sizeof(Vec3) * 2 + feature_tree_.bytes() +
                      triangles_.size() * (sizeof(triangles_[0]) * 2 + sizeof(Vec3)) +
                      at_.size() * sizeof(int) + features_.size() * sizeof(Feature);
  for (const Part& part : parts_) bytes += part.tree.bytes();
  return bytes;
}

void BodySurface::look_at(int triangle, const Vec3& p, Candidate& best) const {
  const Triangle t = corners(triangle);
  const Weights w = nearest_on(t, p);
  const Vec3 d = minus(p, plus(plus(times(t[0], w[0]), times(t[1], w[1])), times(t[2], w[2])));
  const double square = dot(d, d);
  if (square > best.square || (square == best.square && triangle >= best.triangle)) return;
  best = {square, triangle, w};
}

// On a face, an edge or a corner, as the weights say.
BodySurface::Point BodySurface::point_of(const Candidate& c, const Vec3& p) const {
  const auto n = std::size_t(c.triangle);
  const Triangle t = corners(c.triangle);
  const Weights& w = c.weights;
  const Vec3 d = minus(p, plus(plus(times(t[0], w[0]), times(t[1], w[1])), times(t[2], w[2])));
  const int held = (w[0] != 0) + (w[1] != 0) + (w[2] != 0);
  Vec3 normal = face_normals_[n];
  if (held == 1)
    normal = vertex_normals_[std::size_t(triangles_[n][w[0] != 0 ? 0 : w[1] != 0 ? 1 : 2])];
  if (held == 2)
    if (const int other = beside_[n][w[2] == 0 ? 0 : w[0] == 0 ? 1 : 2]; other >= 0)
      normal = plus(normal, face_normals_[std::size_t(other)]);
  const double apart = length(d), side = dot(d, normal) < 0 ? -1 : 1;
  const Vec3 unit = held < 3 && apart > kTouching
                        ? times(d, (closed() ? side : 1) / apart)
                        : times(normal, (closed() ? 1 : side) / std::max(length(normal), 1e-300));
  return {closed() ? side * apart : apart, unit, c.triangle};
}

BodySurface::Point BodySurface::nearest_in(const Part& part, const Vec3& p, int hint,
                                           double enough) const {
  Candidate best;
  best.square = enough;
  look_at(hint >= part.first && hint < part.last ? hint : part.first, p, best);
  part.tree.nearest(p, best.square, [&](int n) { look_at(part.first + n, p, best); });
  return best.triangle < 0 ? Point{1e300, {}, -1} : point_of(best, p);
}

BodySurface::Point BodySurface::nearest(const Vec3& p, int hint) const {
  Point best{1e300, {}, -1};
  for (const Part& part : parts_) {
    const double square = part.tree.bounds().square_from(p);
    const double most = best.distance > 0 ? best.distance * best.distance : 0;
    // What p is outside of can only be nearer.
    if (square > most) continue;
    const Point one = nearest_in(part, p, hint, square > 0 ? most : 1e300);
    if (one.distance < best.distance) best = one;
  }
  return best;
}

BodySurface::Point BodySurface::nearest_among(std::span<const int> triangles, const Vec3& p) const {
  Point best{1e300, {}, -1};
  for (std::size_t n = 0; n < triangles.size();) {
    const int first = triangles[n];
    const int last =
        parts_.size() == 1
            ? parts_[0].last
            : std::upper_bound(parts_.begin(), parts_.end(), first, [](int t, const Part& part) {
                return t < part.last;
              })->last;
    Candidate nearest;
    for (; n < triangles.size() && triangles[n] < last; ++n) look_at(triangles[n], p, nearest);
    const Point one = point_of(nearest, p);
    if (one.distance < best.distance) best = one;
  }
  return best;
}

int BodySurface::within(const Vec3& p, double distance, std::array<int, kListed>& found) const {
  AlignedBox box;
  box.add(p);
  box = box.grown(distance);
  int count = 0;
  for (const Part& part : parts_)
    part.tree.within(box, [&](int n) {
      Candidate one;
      look_at(part.first + n, p, one);
      if (one.square > distance * distance) return;
      if (count < kListed) found[std::size_t(count)] = part.first + n;
      ++count;
    });
  if (count > kListed) return -1;
  std::sort(found.begin(), found.begin() + count);
  return count;
}

// By Moller and Trumbore (1997). What passes an edge is not to be lost.
int BodySurface::first_on(const Vec3& from, const Vec3& to, Vec3& hit) const {
  constexpr double kEdge = 1e-9;
  const Vec3 way = minus(to, from);
  AlignedBox box;
  box.add(from);
  box.add(to);
  double first = 2;
  int triangle = -1;
  for (const Part& part : parts_)
    part.tree.within(box, [&](int n) {
      const Triangle t = corners(part.first + n);
      const Vec3 e = minus(t[1], t[0]), f = minus(t[2], t[0]), s = minus(from, t[0]);
      const Vec3 across = cross(way, f), q = cross(s, e);
      const double det = dot(e, across);
      if (det == 0) return;
      const double u = dot(s, across) / det, v = dot(way, q) / det, at = dot(f, q) / det;
      const bool meets = u >= -kEdge && v >= -kEdge && u + v <= 1 + kEdge && at >= 0 && at <= 1;
      if (!meets || at > first || (at == first && part.first + n > triangle)) return;
      first = at;
      triangle = part.first + n;
    });
  hit = plus(from, times(way, first));
  return triangle;
}

// What is only pressed into the surface sees the same side from both ends of its path.
BodySurface::Point BodySurface::entered_at(const Vec3& before, const Vec3& now, const Point& was,
                                           const Point& is) const {
  constexpr double kSameSide = 0.5;  // cosine
  if (dot(was.normal, is.normal) > kSameSide) return is;
  Vec3 hit;
  const int triangle = first_on(before, now, hit);
  if (triangle < 0) return is;
  const Vec3& n = face_normals_[std::size_t(triangle)];
  const double beyond = dot(minus(now, hit), n);
  return beyond < 0 ? Point{beyond, n, triangle} : is;
}

BodySurface::Point BodySurface::on_side_of(const Vec3& before, const Vec3& now,
                                           const Point& is) const {
  constexpr double kSameSheet = 0.5;  // cosine
  Vec3 hit;
  const int triangle = first_on(before, now, hit);
  if (triangle < 0) return is;
  const Vec3& n = face_normals_[std::size_t(triangle)];
  const Vec3 back = times(n, dot(minus(now, before), n) > 0 ? -1 : 1);  // to where it was
  if (dot(is.normal, back) < -kSameSheet) return {-is.distance, times(is.normal, -1), is.triangle};
  return {dot(minus(now, hit), back), back, triangle};
}

std::shared_ptr<const BodySurface> surface_of(const MeshBody& body) {
  MeshSource about = body;
  about.translate = {};
  return std::make_shared<const BodySurface>(*body.shape, placed_vertices(about));
}

std::span<const std::array<int, 2>> open_edges(const BodySurface& surface) {
  return surface.open_edges();
}

}  // namespace weft
