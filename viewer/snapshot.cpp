// Copies of the simulation's arrays, and where its colliders are.
#include "snapshot.h"

namespace weft::viewer {

namespace {

void copy(std::span<const float> from, std::vector<float>& to) {
  to.assign(from.begin(), from.end());
}

Vec3 path_position(const std::vector<Key>& keys, double time) {
  if (time <= keys.front().time) return keys.front().position;
  for (std::size_t k = 1; k < keys.size(); ++k) {
    const Key &a = keys[k - 1], &b = keys[k];
    if (time > b.time) continue;
    const double t = (time - a.time) / (b.time - a.time);
    Vec3 p{};
    for (std::size_t c = 0; c < 3; ++c) p[c] = a.position[c] + t * (b.position[c] - a.position[c]);
    return p;
  }
  return keys.back().position;
}

void move_to(Sphere& sphere, const Vec3& p) {
  sphere.center = p;
}
void move_to(Plane& plane, const Vec3& p) {
  plane.point = p;
}
void move_to(Box& box, const Vec3& p) {
  box.center = p;
}
void move_to(Capsule& capsule, const Vec3& p) {
  for (std::size_t c = 0; c < 3; ++c) capsule.b[c] += p[c] - capsule.a[c];
  capsule.a = p;
}

void add_bounds(const Sphere& s, Bounds& bounds) {
  bounds.add_ball(to_float(s.center), static_cast<float>(s.radius));
}
void add_bounds(const Plane&, Bounds&) {}
void add_bounds(const Capsule& c, Bounds& bounds) {
  bounds.add_ball(to_float(c.a), static_cast<float>(c.radius));
  bounds.add_ball(to_float(c.b), static_cast<float>(c.radius));
}
void add_bounds(const Box& b, Bounds& bounds) {
  bounds.add_ball(to_float(b.center), length(to_float(b.half)));
}

}  // namespace

void copy_view(const View& view, Snapshot& to) {
  to.time = view.time;
  to.cloths.resize(view.cloths.size());
  for (std::size_t c = 0; c < view.cloths.size(); ++c) {
    const ClothView& from = view.cloths[c];
    ClothCopy& cloth = to.cloths[c];
    cloth.columns = from.columns;
    cloth.rows = from.rows;
    cloth.stride = from.stride;
    copy(from.x, cloth.x);
    copy(from.y, cloth.y);
    copy(from.z, cloth.z);
    copy(from.vx, cloth.vx);
    copy(from.vy, cloth.vy);
    copy(from.vz, cloth.vz);
    copy(from.inverse_mass, cloth.inverse_mass);
    cloth.topology_version = from.topology_version;
  }
}

Collider collider_at(const Collider& collider, double time) {
  Collider moved = collider;
  if (collider.keys.empty()) return moved;
  const Vec3 p = path_position(collider.keys, time);
  std::visit([&](auto& shape) { move_to(shape, p); }, moved.shape);
  return moved;
}

Bounds collider_bounds(const Scene& scene, double time) {
  Bounds bounds;
  for (const Collider& collider : scene.colliders) {
    const Collider now = collider_at(collider, time);
    std::visit([&](const auto& shape) { add_bounds(shape, bounds); }, now.shape);
  }
  return bounds;
}

Bounds cloth_bounds(const Snapshot& snapshot) {
  Bounds bounds;
  for (const ClothCopy& cloth : snapshot.cloths)
    for (int j = 0; j < cloth.rows; ++j)
      for (int i = 0; i < cloth.columns; ++i) bounds.add(cloth.position(i, j));
  return bounds;
}

}  // namespace weft::viewer
