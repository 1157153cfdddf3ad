// Copies of the simulation's arrays, and where its colliders are.
#include "picture/frame_data.h"

namespace weft::viewer {

namespace {

void copy(std::span<const float> from, std::vector<float>& to) {
  to.assign(from.begin(), from.end());
}

// The values of a mesh in the order of its numbers, and its triangles by them.
void put_in_order(std::span<const std::uint32_t> lanes, ClothCopy& cloth) {
  std::vector<std::uint32_t> numbers(cloth.x.size());
  for (std::size_t n = 0; n < lanes.size(); ++n) numbers[lanes[n]] = static_cast<std::uint32_t>(n);
  for (auto* values :
       {&cloth.x, &cloth.y, &cloth.z, &cloth.vx, &cloth.vy, &cloth.vz, &cloth.inverse_mass}) {
    std::vector<float> ordered(lanes.size());
    for (std::size_t n = 0; n < lanes.size(); ++n) ordered[n] = (*values)[lanes[n]];
    values->swap(ordered);
  }
  for (auto& triangle : cloth.triangles)
    for (std::uint32_t& corner : triangle) corner = numbers[corner];
  for (std::uint32_t& particle : cloth.tear_particles) particle = numbers[particle];
  cloth.columns = cloth.stride = static_cast<int>(lanes.size());
  cloth.rows = 1;
}

Vec3 negative(const Vec3& p) {
  return {-p[0], -p[1], -p[2]};
}

}  // namespace

void copy_view(const View& view, const Scene& scene, FrameData& to) {
  to.origin = view.origin;
  to.bodies.clear();
  for (const Collider& collider : scene.colliders) {
    to.bodies.push_back(collider_at(collider, view.time));
    to.bodies.back().shape = moved(to.bodies.back().shape, negative(view.origin));
  }
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
    cloth.tear_points.assign(from.tear_points.begin(), from.tear_points.end());
    cloth.tear_particles.assign(from.tear_particles.begin(), from.tear_particles.end());
    cloth.tear_triangles.assign(from.tear_triangles.begin(), from.tear_triangles.end());
    cloth.mesh = !from.lanes.empty();
    if (cloth.mesh) put_in_order(from.lanes, cloth);
  }
}

Collider collider_at(const Collider& collider, double time) {
  Collider now;
  now.shape = shape_at(collider, time);
  now.friction = collider.friction;
  now.offset = collider.offset;
  now.cuts = collider.cuts;
  now.color = collider.color;
  return now;
}

Shape about_its_place(const Shape& shape) {
  Shape about = moved(shape, negative(place_of(shape)));
  for_each_value(about, [](const char*, auto& value, ShapeValue is) {
    if constexpr (std::is_same_v<decltype(value), Vec3&>)
      if (is == ShapeValue::point) value = to_double(to_float(value));
  });
  return about;
}

Bounds collider_bounds(const std::vector<Collider>& bodies) {
  Bounds bounds;
  for (const Collider& body : bodies)
    if (const auto corners = bounds_of(body.shape))
      for (const Vec3& corner : *corners) bounds.add(to_float(corner));
  return bounds;
}

Bounds cloth_bounds(const FrameData& frame_data) {
  Bounds bounds;
  for (const ClothCopy& cloth : frame_data.cloths) {
    for (const auto& triangle : cloth.triangles)
      for (const std::uint32_t p : triangle) bounds.add(Vec3f{cloth.x[p], cloth.y[p], cloth.z[p]});
    for (int j = 0; j < cloth.rows && !cloth.torn; ++j)
      for (int i = 0; i < cloth.columns; ++i) bounds.add(cloth.position(j * cloth.columns + i));
  }
  return bounds;
}

}  // namespace weft::viewer
