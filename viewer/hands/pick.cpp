// Triangles by Moller and Trumbore (1997), colliders by sphere tracing (Hart 1996).
#include "hands/pick.h"

#include "weft/shape.h"

namespace weft::viewer {

Ray ray_through(const Camera& camera, const Area& area, float x, float y) {
  const float u = 2 * (x - area.x) / area.width - 1, v = 1 - 2 * (y - area.y) / area.height;
  return {camera.eye(), camera.ray(u, v, area.aspect())};
}

Projector::Projector(const Camera& camera, const Area& area)
    : matrix_(camera.projection(area.aspect()) * camera.view()), area_(area) {}

ScreenPoint Projector::operator()(Vec3f p) const {
  const auto& m = matrix_.m;
  const auto row = [&](std::size_t r) {
    return m[r] * p.x + m[4 + r] * p.y + m[8 + r] * p.z + m[12 + r];
  };
  const float w = row(3);
  if (w <= 0) return {};
  return {area_.x + area_.width * 0.5f * (1 + row(0) / w),
          area_.y + area_.height * 0.5f * (1 - row(1) / w), w, true};
}

namespace {

struct TriangleHit {
  float distance, u, v;
};

std::optional<TriangleHit> meet(const Ray& ray, Vec3f a, Vec3f b, Vec3f c) {
  const Vec3f e = b - a, f = c - a, p = cross(ray.direction, f);
  const float det = dot(e, p);
  if (det == 0) return std::nullopt;
  const Vec3f s = ray.origin - a, q = cross(s, e);
  const float u = dot(s, p) / det, v = dot(ray.direction, q) / det, t = dot(f, q) / det;
  if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 0)) return std::nullopt;
  return TriangleHit{t, u, v};
}

class ClothPick {
 public:
  ClothPick(const FrameData& frame_data, const Ray& ray) : frame_data_(frame_data), ray_(ray) {}

  void triangle(int cloth, std::size_t a, std::size_t b, std::size_t c) {
    const ClothCopy& copy = frame_data_.cloths[std::size_t(cloth)];
    const auto at = [&](std::size_t p) { return Vec3f{copy.x[p], copy.y[p], copy.z[p]}; };
    const auto hit = meet(ray_, at(a), at(b), at(c));
    if (!hit || (best && best->distance <= hit->distance)) return;
    const float w = 1 - hit->u - hit->v;
    const std::size_t nearest = w >= hit->u && w >= hit->v ? a : hit->u >= hit->v ? b : c;
    const auto stride = static_cast<std::size_t>(copy.stride);
    const std::size_t particle =
        nearest / stride * static_cast<std::size_t>(copy.columns) + nearest % stride;
    best = ClothHit{cloth, static_cast<int>(particle), ray_.origin + ray_.direction * hit->distance,
                    hit->distance};
  }

  std::optional<ClothHit> best;

 private:
  const FrameData& frame_data_;
  const Ray& ray_;
};

}  // namespace

std::optional<ClothHit> pick_cloth(const FrameData& frame_data, const Ray& ray) {
  ClothPick pick(frame_data, ray);
  for (std::size_t n = 0; n < frame_data.cloths.size(); ++n) {
    const ClothCopy& cloth = frame_data.cloths[n];
    const int c = static_cast<int>(n);
    for (const auto& t : cloth.triangles) pick.triangle(c, t[0], t[1], t[2]);
    for (int j = 0; j + 1 < cloth.rows && !cloth.torn; ++j)
      for (int i = 0; i + 1 < cloth.columns; ++i) {
        const std::size_t a = cloth.at(i, j), below = cloth.at(i, j + 1);
        pick.triangle(c, a, a + 1, below);
        pick.triangle(c, a + 1, below + 1, below);
      }
  }
  return pick.best;
}

std::optional<BodyHit> pick_body(const FrameData& frame_data, const Ray& ray) {
  constexpr int kMostSteps = 96;
  const float scene = 1e-4f * (1 + length(ray.origin));
  std::optional<BodyHit> best;
  for (std::size_t n = 0; n < frame_data.bodies.size(); ++n) {
    const Collider& body = frame_data.bodies[n];
    if (std::holds_alternative<Plane>(body.shape)) continue;
    float t = 0;
    for (int k = 0; k < kMostSteps; ++k) {
      const Vec3f p = ray.origin + ray.direction * t;
      const auto left = static_cast<float>(signed_distance(body, 0, to_double(p)));
      if (left > scene) {
        t += left;
        continue;
      }
      if (!best || t < best->distance) best = BodyHit{static_cast<int>(n), p, t};
      break;
    }
  }
  return best;
}

Vec3f on_plane(const Ray& ray, Vec3f on, Vec3f normal) {
  const float along = dot(ray.direction, normal);
  if (std::abs(along) < 1e-6f) return on;
  return ray.origin + ray.direction * (dot(on - ray.origin, normal) / along);
}

}  // namespace weft::viewer
