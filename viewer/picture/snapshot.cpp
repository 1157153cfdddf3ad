// Copies of the simulation's arrays, and where its colliders are.
#include "picture/snapshot.h"

#include "weft/shape.h"

namespace weft::viewer {

namespace {

void copy(std::span<const float> from, std::vector<float>& to) {
  to.assign(from.begin(), from.end());
}

void move_by(Vec3& p, const Vec3& by) {
  for (std::size_t c = 0; c < 3; ++c) p[c] += by[c];
}
void move_by(Sphere& sphere, const Vec3& by) {
  move_by(sphere.center, by);
}
void move_by(Plane& plane, const Vec3& by) {
  move_by(plane.point, by);
}
void move_by(Box& box, const Vec3& by) {
  move_by(box.center, by);
}
void move_by(Capsule& capsule, const Vec3& by) {
  move_by(capsule.a, by);
  move_by(capsule.b, by);
}

Vec3 place(const Sphere& s) {
  return s.center;
}
Vec3 place(const Plane& p) {
  return p.point;
}
Vec3 place(const Box& b) {
  return b.center;
}
Vec3 place(const Capsule& c) {
  return c.a;
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

void copy_view(const View& view, const Scene& scene, Snapshot& to) {
  to.bodies.clear();
  for (const Collider& collider : scene.colliders)
    to.bodies.push_back(collider_at(collider, view.time));
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
    cloth.torn = from.topology_version > 0;
    cloth.topology_version = from.topology_version;
    cloth.triangles.assign(from.triangles.begin(), from.triangles.end());
    if (!cloth.torn) cloth.triangles.clear();
    cloth.seam_points.assign(from.seam_points.begin(), from.seam_points.end());
    cloth.seam_particles.assign(from.seam_particles.begin(), from.seam_particles.end());
    cloth.seams.assign(from.seams.begin(), from.seams.end());
  }
}

Collider collider_at(const Collider& collider, double time) {
  Collider moved{collider.shape, collider.friction, collider.offset, {}, collider.cuts};
  if (collider.keys.empty()) return moved;
  std::visit([&](auto& shape) { move_by(shape, displacement(collider, time)); }, moved.shape);
  return moved;
}

Vec3 place_of(const Collider& collider) {
  return std::visit([](const auto& shape) { return place(shape); }, collider.shape);
}

Shape about_its_place(const Collider& collider) {
  Shape shape = collider.shape;
  const Vec3 place = place_of(collider);
  std::visit([&](auto& moved) { move_by(moved, {-place[0], -place[1], -place[2]}); }, shape);
  if (Capsule* capsule = std::get_if<Capsule>(&shape)) capsule->b = to_double(to_float(capsule->b));
  return shape;
}

Bounds collider_bounds(const std::vector<Collider>& bodies) {
  Bounds bounds;
  for (const Collider& body : bodies)
    std::visit([&](const auto& shape) { add_bounds(shape, bounds); }, body.shape);
  return bounds;
}

Bounds cloth_bounds(const Snapshot& snapshot) {
  Bounds bounds;
  for (const ClothCopy& cloth : snapshot.cloths) {
    for (const auto& triangle : cloth.triangles)
      for (const std::uint32_t p : triangle) bounds.add(Vec3f{cloth.x[p], cloth.y[p], cloth.z[p]});
    for (int j = 0; j < cloth.rows && !cloth.torn; ++j)
      for (int i = 0; i < cloth.columns; ++i) bounds.add(cloth.position(i, j));
  }
  return bounds;
}

}  // namespace weft::viewer
