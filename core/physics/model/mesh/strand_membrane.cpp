#include "physics/model/mesh/strand_membrane.h"

#include <Eigen/Dense>
#include <algorithm>

#include "weft/vec3.h"

namespace weft::physics {
namespace {

// T of side k: q by strains e11, e22 and the sine.
Eigen::Vector3d along(const RestTriangle& r, std::size_t k) {
  Eigen::Matrix2d d;
  d << r.du[0], r.dv[0], r.du[1], r.dv[1];
  const Eigen::Matrix2d places = d.inverse();
  const Eigen::Vector2d p = places.col(0), q = places.col(1), sides[3] = {p, q - p, -q},
                        s = sides[k];
  return {s[0] * s[0], s[1] * s[1], s[0] * s[1]};
}

}  // namespace

// A triangle's share in an edge is as its stiffness along it.
StrandMembrane::StrandMembrane(const ClothParts& parts, const std::vector<RestTriangle>& triangles,
                               const MeshEdges& edges, StrainSweeps& strains)
    : parts_(parts), strains_(strains), edges_(edges.ends.size()) {
  const Membrane& m = parts.cloth.membrane;
  Eigen::Matrix3d c;
  c << m.warp, m.coupling, 0, m.coupling, m.weft, 0, 0, 0, m.shear;
  const Eigen::Matrix3d gives = c.inverse();
  std::vector<double> stiffness(edges.ends.size()), square(edges.ends.size());
  const auto for_each_side = [&](const auto& visit) {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = triangles[t].corner[k], b = triangles[t].corner[(k + 1) % 3];
        const auto at = std::lower_bound(edges.ends.begin(), edges.ends.end(),
                                         Joined{std::min(a, b), std::max(a, b)});
        const Eigen::Vector3d side = along(triangles[t], k);
        visit(std::size_t(at - edges.ends.begin()), t, k, side,
              triangles[t].area / side.dot(gives * side));
      }
  };
  for_each_side(
      [&](std::size_t e, std::size_t, std::size_t, const auto&, double k) { stiffness[e] += k; });
  for_each_side([&](std::size_t e, std::size_t t, std::size_t k, const auto& side, double own) {
    Edge& edge = edges_[e];
    Side& s = edge.sides[edge.sides[0].held ? 1 : 0];
    const double share = own / stiffness[e];
    const Eigen::Vector3d give = share * gives * side;
    s.held = strains_.stress(int(t));
    for (int n = 0; n < 3; ++n) {
      s.give[n] = float(give[n]);
      s.stress[n] = float(share * side[n] / triangles[t].area);
    }
    square[e] += share * triangles[t].rest[k] * triangles[t].rest[k];
  });
  const auto lane = [&](int v) { return int(parts.particles.lane(v)); };
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    edges_[e].ends = {lane(edges.ends[e][0]), lane(edges.ends[e][1])};
    edges_[e].square = float(square[e]);
    edges_[e].give = float(1 / stiffness[e]);
  }
}

float StrandMembrane::square(int edge, float rate) const {
  const Edge& e = edges_[std::size_t(edge)];
  float held = 0;
  for (const Side& side : e.sides)
    for (int n = 0; n < 3 && side.held; ++n) held += side.give[n] * side.held[n * kBatch];
  if (rate == 0) return e.square - 2 * held;
  const Vec3 before = minus(strains_.place_before(e.ends[1]), strains_.place_before(e.ends[0]));
  const float gone = float(dot(before, before)) - e.square;
  return e.square + (rate * gone - 2 * held) / (1 + rate);
}

void StrandMembrane::add(int edge, float multiplier, float inverse_dt2) {
  for (const Side& side : edges_[std::size_t(edge)].sides)
    for (int n = 0; n < 3 && side.held; ++n)
      side.held[n * kBatch] += side.stress[n] * (multiplier * inverse_dt2);
}

}  // namespace weft::physics
