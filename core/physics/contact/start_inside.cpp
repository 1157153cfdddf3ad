// What of a cloth lies inside a collider (start_inside.h).
#include "physics/contact/start_inside.h"

#include <algorithm>
#include <cmath>

#include "physics/contact/body/body_triangle.h"
#include "physics/contact/triangle_shape.h"
#include "physics/model/placement.h"

namespace weft::physics {
namespace {

// The least distance of a point of a triangle that cuts the core of a shape. That of a convex shape is a
// convex function, so that nested golden sections find it.
template <class Shape>
double least_of_cut(const Shape& shape, const Corners& c) {
  constexpr int kSections = 40;  // to 1e-8 of an edge
  constexpr double kGolden = 0.6180339887498949;
  const auto least = [](const auto& f) {
    double low = 0, high = 1;
    for (int n = 0; n < kSections; ++n) {
      const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
      (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
    }
    return f((low + high) / 2);
  };
  return least([&](double u) {
    return least([&](double v) {
      return nearest_of(shape, c.at({1 - u, u * (1 - v), u * v})).distance;
    });
  });
}

// m; how far the surface of a shape is from its core.
template <class Shape>
double rounding_of(const Shape& shape, const Vec3& p) {
  return core_of(shape, p).radius;
}
double rounding_of(const MeshBody&, const Vec3&) {
  return 0;
}

// Of a mesh: what its edges and corners find.
double least_of_cut(const MeshBody& body, const Corners& c) {
  return deepest_on(body, c, 0, longest_side(c.x)).nearest.distance;
}

void find_triangles_inside(const ClothParts& parts, const Collider& collider, StartInside& found) {
  if (!caught_by_triangles(collider)) return;
  const Particles& l = parts.particles;
  const bool resolved = resolves(parts.cloth, collider);
  const AllowedDepth allowed(parts.cloth, collider);
  const double edge = longest_edge(parts.cloth);
  const Upright upright(at_time(collider.shape, found.time));
  const Placement placement(collider, found.time);
  for (const std::array<int, 3>& triangle : parts.model.surface().triangles) {
    Corners c{};
    bool moves = false;
    for (int k = 0; k < 3; ++k) {
      const auto [j, i] = l.place(triangle[std::size_t(k)]);
      c.x[k] = upright.into(placement.seen(l.position(j, i)));
      moves |= l.w(j, i) > 0;
    }
    const double longest = longest_side(c.x);
    const double offset = collider.offset - (resolved ? allowed.at(longest) : 0);
    const double depth = std::visit(
        [&](const auto& shape) {
          // No point of a triangle is further from a corner than its longest side.
          if (!moves || nearest_of(shape, c.x[0]).distance > offset + longest) return 0.0;
          return offset - deepest_on(shape, c, offset, edge).nearest.distance;
        },
        upright.shape);
    found.deepest_triangle = std::max(found.deepest_triangle, depth);
    found.triangles += depth > kTouchingStart;
  }
  if (found.triangles == 0) found.deepest_triangle = 0;
}

}  // namespace

StartInside start_inside(const ClothParts& parts, const Collider& collider, double time) {
  StartInside found;
  found.time = time;
  if (collider.cuts) return found;
  const Particles& l = parts.particles;
  l.for_each([&](int j, int i) {
    const double distance = signed_distance(collider, time, l.position(j, i));
    const double depth = l.w(j, i) > 0 ? collider.offset - distance : 0;
    found.deepest_particle = std::max(found.deepest_particle, depth);
    found.particles += depth > kTouchingStart;
  });
  if (found.particles == 0) found.deepest_particle = 0;
  find_triangles_inside(parts, collider, found);
  return found;
}

double deepest_in(const Cloth& cloth, const Collider& collider, double time,
                  std::span<const Vec3> x, std::span<const std::array<std::int32_t, 3>> triangles) {
  const Placement placement(collider, time);
  const Upright upright(at_time(collider.shape, time));
  const AllowedDepth allowed(cloth, collider);
  const double at_rest = longest_edge(cloth);
  constexpr double kFlatness = 0.02;  // of an edge: so deep a moving sheet cuts a sharp edge
  return std::visit(
      [&](const auto& shape) {
        std::vector<double> distances(x.size());
        std::vector<Vec3> seen(x.size());
        double least = 0;
        for (std::size_t p = 0; p < x.size(); ++p) {
          seen[p] = upright.into(placement.seen(x[p]));
          distances[p] = nearest_of(shape, seen[p]).distance;
          least = std::min(least, distances[p]);
        }
        if (std::isinf(feature_of(shape))) return -least;
        for (const auto& t : triangles) {
          Corners c{};
          double nearest = 1e300;
          for (std::size_t k = 0; k < 3; ++k) {
            c.x[k] = seen[std::size_t(t[k])];
            nearest = std::min(nearest, distances[std::size_t(t[k])]);
          }
          const double edge = longest_side(c.x);
          if (nearest - edge >= least) continue;  // no point is further from a corner
          const double depth = deepest_on(shape, c, 0, edge).nearest.distance;
          if (-depth <= allowed.at(edge) - collider.offset + kFlatness * std::min(edge, at_rest))
            continue;
          const bool cut = depth < -rounding_of(shape, c.x[0]);
          least = std::min(least, cut ? least_of_cut(shape, c) : depth);
        }
        return -least;
      },
      upright.shape);
}

}  // namespace weft::physics
