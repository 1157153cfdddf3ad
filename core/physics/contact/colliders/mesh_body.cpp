// Collider mesh: a body of triangles (contact/body). What the kernels need of its surface has been found for
// every particle of the row before they run (BodyProbe).
#ifdef WEFT_LANES

#include "physics/kernels/collide.h"

namespace weft::WEFT_KERNELS {
namespace {

struct MeshSurface {
  static constexpr bool kFlat = false;
  explicit MeshSurface(const physics::ShapeConstants& c) : found(*c.found) {}
  WEFT_INLINE Surface now(int i) const {
    return {load(found.distance + i), load3(found.normal, i)};
  }
  WEFT_INLINE Surface before(int i) const {
    return {load(found.distance_before + i), load3(found.normal_before, i)};
  }
  // Beside the collider's.
  WEFT_INLINE Wide3 velocity(int i) const {
    return found.velocity.x ? load3(found.velocity, i) : Wide3{};
  }
  const physics::FoundSurface& found;
};

RowReach coulomb(const CollideRow& r) {
  return collide_row<MeshSurface, false>(r);
}
RowReach course(const CollideRow& r) {
  return collide_row<MeshSurface, true>(r);
}
RowReach damp_sliding(const CollideRow& r) {
  return damp_sliding_row<MeshSurface>(r);
}

}  // namespace
// Its triangles are found by the tree of its features.
const physics::ColliderKernels kMeshBody = {{coulomb, course}, nullptr, damp_sliding};
}  // namespace weft::WEFT_KERNELS

#else

#include <cmath>
#include <limits>

#include "physics/contact/body/body_surface.h"
#include "physics/contact/colliders/shapes.h"
#include "weft/mesh.h"
#include "weft/turn.h"

namespace weft {

double MeshBody::half_thickness() const {
  const bool open = surface && !open_edges(*surface).empty();
  return open ? 0 : std::numeric_limits<double>::infinity();
}

namespace physics {

ShapeConstants constants_of(const MeshBody&) {
  return {};
}

Nearest nearest_of(const MeshBody& body, const Vec3& p) {
  return nearest_of(body, body.time, p);
}

Nearest nearest_of(const MeshBody& body, double time, const Vec3& p) {
  const BodyMoment moment = body.surface->at(time);
  if (body.turn == Vec3{}) {
    const BodyMoment::Point point = moment.nearest(p);
    return {point.distance, point.normal};
  }
  const Matrix turn = matrix_of(body.turn);
  const BodyMoment::Point point = moment.nearest(times_transpose(turn, p));
  return {point.distance, times(turn, point.normal)};
}

double feature_of(const MeshBody& body) {
  return body.surface->least_radius();
}

// Smooth but for edges that bend by more than kCrease: at each corner the normals about it that are near to
// the triangle's own.
ShapeMesh mesh_of(const MeshBody& body) {
  constexpr double kCrease = 0.7;  // cosine
  const BodyMoment moment = body.surface->at(body.time);
  const BodyForm& form = moment.form();
  std::vector<Vec3> normals;
  for (std::size_t n = 0; n < form.triangles.size(); ++n)
    normals.push_back(moment.face_normal(int(n)));
  ShapeMesh mesh;
  for (std::size_t n = 0; n < form.triangles.size(); ++n) {
    for (const int vertex : form.triangles[n]) {
      Vec3 sum{};
      for (const int other : form.at_vertex(vertex)) {
        const Vec3& normal = normals[std::size_t(other)];
        if (dot(normals[n], normal) > kCrease) sum = plus(sum, normal);
      }
      mesh.positions.push_back(moment.vertex(vertex));
      mesh.normals.push_back(unit(sum));
    }
    const auto first = std::uint32_t(3 * n);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  if (body.turn == Vec3{}) return mesh;
  const Matrix turn = matrix_of(body.turn);
  for (std::vector<Vec3>* vectors : {&mesh.positions, &mesh.normals})
    for (Vec3& v : *vectors) v = times(turn, v);
  return mesh;
}

}  // namespace physics

}  // namespace weft

#endif
