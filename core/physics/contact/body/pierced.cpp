// Edges of bodies through cloth (pierced.h).
#include "physics/contact/body/pierced.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "physics/contact/body/body_surface.h"
#include "physics/contact/body/meeting.h"
#include "physics/contact/colliders/shapes.h"
#include "physics/contact/moving_collider.h"
#include "physics/model/placement.h"

namespace weft::physics {
namespace {

// Of the cloth's longest edge: so far inside of an edge of the body it is looked for, and so far from both of the faces
// beside that. What rests on them lies less deep.
constexpr double kInside = 0.01, kFromFaces = 4 * AllowedDepth::kSlack;

struct Segment {
  Vec3 from, to;
};

// The part of a feature's edge that lies inside of the body, moved away from both faces; none where that is all.
std::optional<Segment> inside(const BodyMoment& now, const BodyForm::Feature& f, double edge) {
  const Vec3 outward = now.outward(f);
  const double lean = dot(outward, now.face_normal(f.triangle));
  const double by = edge * std::max(kInside, kFromFaces / std::max(lean, 1e-6));
  const Vec3 p = now.vertex(f.a), q = now.vertex(f.b), along = minus(q, p);
  const double size = length(along);
  // From a corner on the body is as wide only where its edges have spread so far.
  const auto cut = [&](int vertex, const Vec3& way) {
    const double cosine = -dot(now.vertex_normal(vertex), way);
    return by * std::max(0.0, cosine) / std::sqrt(std::max(1e-12, 1 - cosine * cosine)) / size;
  };
  const Vec3 way = times(along, 1 / size);
  const double begin = cut(f.a, way), end = 1 - cut(f.b, times(way, -1));
  if (!(begin < end)) return {};
  const Vec3 moved = plus(p, times(outward, -by));
  return Segment{plus(moved, times(along, begin)), plus(moved, times(along, end))};
}

int places_of(const ClothModel& model, const Collider& collider, const BodySurface& body,
              double time) {
  const ClothParts& parts = model.parts();
  const double edge = longest_edge(parts.cloth), sharp = kSmallFeature * edge;
  if (!body.closed() || !(body.least_radius() < sharp)) return 0;
  const Placement placement(collider, time);
  const BodyMoment now = body.at(time);
  int places = 0;
  for (const std::array<int, 3>& corners : model.surface().triangles) {
    Triangle t;
    AlignedBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [j, i] = parts.particles.place(corners[k]);
      t[k] = placement.seen(parts.particles.position(j, i));
      box.add(t[k]);
    }
    now.features(
        sharp, [&](int node) { return now.feature_box(node).meets(box); },
        [&](int n) {
          const BodyForm::Feature& f = now.form().features[std::size_t(n)];
          if (f.a == f.b) return;
          const std::optional<Segment> edge_inside = inside(now, f, edge);
          places += edge_inside && meets(edge_inside->from, edge_inside->to, t).at <= 1;
        });
  }
  return places;
}

}  // namespace

Pierced pierced(const ClothModel& model, double time) {
  const std::vector<Collider>& colliders = model.parts().scene.colliders;
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    const BodySurface* const body = surface_of(colliders[k]);
    if (!body || colliders[k].cuts) continue;
    if (const int places = places_of(model, colliders[k], *body, time); places > 0)
      return {int(k), places};
  }
  return {};
}

}  // namespace weft::physics
