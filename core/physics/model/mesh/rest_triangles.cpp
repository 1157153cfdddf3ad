#include "physics/model/mesh/rest_triangles.h"

#include <algorithm>
#include <cmath>

#include "physics/model/mesh/plate_moments.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

// The direction of warp in a triangle, of unit length.
Vec3 warp_of(const TriangleMesh& mesh, std::size_t t, const Vec3& p, const Vec3& q, const Vec3& n) {
  Vec3 warp{};
  if (!mesh.uv.empty()) {
    const auto& [a, b, c] = mesh.uv[t];
    // ∂x/∂u of x(u, v) along p and q.
    const double v1 = b[1] - a[1], v2 = c[1] - a[1];
    const double turn = (b[0] - a[0]) * v2 - (c[0] - a[0]) * v1;
    warp = times(minus(times(p, v2), times(q, v1)), turn < 0 ? -1 : 1);
  }
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}}) {
    if (length(warp) > 0) break;
    const Vec3 along = minus(axis, times(n, dot(axis, n)));
    if (length(along) > 0.1) warp = along;
  }
  return times(warp, 1 / length(warp));
}

// Of corner c seen from the side a, b.
Foot foot_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 side = minus(b, a), way = minus(c, a);
  const double at = dot(way, side) / dot(side, side);
  return {length(minus(way, times(side, at))), at};
}

// What lies across each side.
struct Across {
  int vertex = -1, triangle = -1;  // -1: none
  std::size_t side = 0;            // of that triangle
};
struct Side {
  int low, high, triangle, k;
};
std::vector<std::array<Across, 3>> across_of(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][std::size_t(k)],
                b = mesh.triangles[t][std::size_t(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), int(t), k});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  std::vector<std::array<Across, 3>> across(mesh.triangles.size());
  const auto beyond = [&](const Side& s) {
    const int third = mesh.triangles[std::size_t(s.triangle)][std::size_t(s.k + 2) % 3];
    return Across{third, s.triangle, std::size_t(s.k)};
  };
  for (std::size_t n = 1; n < sides.size(); ++n) {
    const Side &a = sides[n - 1], &b = sides[n];
    if (a.low != b.low || a.high != b.high) continue;
    across[std::size_t(a.triangle)][std::size_t(a.k)] = beyond(b);
    across[std::size_t(b.triangle)][std::size_t(b.k)] = beyond(a);
  }
  return across;
}

// Where a triangle's six corners are at rest, as seen from itself.
using Places = std::array<Vec3, 6>;

Places places_of(const RestTriangle& r, const std::vector<Vec3>& x) {
  Places places{};
  for (std::size_t c = 0; c < 6; ++c)
    if (r.corner[c] >= 0) places[c] = x[std::size_t(r.corner[c])];
  return places;
}

// On the flat pattern, in the plane z = 0 and counter-clockwise; neighbours are unfolded about the common side.
Places places_of(const TriangleMesh& mesh, std::size_t t, const std::array<Across, 3>& across,
                 double scale) {
  const auto on_pattern = [&](std::size_t triangle, std::size_t k) {
    const TriangleMesh::Uv& at = mesh.uv[triangle][k % 3];
    return Vec3{scale * at[0], scale * at[1], 0};
  };
  Places places{};
  for (std::size_t k = 0; k < 3; ++k) places[k] = on_pattern(t, k);
  if (cross(minus(places[1], places[0]), minus(places[2], places[0]))[2] < 0)
    for (std::size_t k = 0; k < 3; ++k) places[k][1] *= -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& [vertex, other, side] = across[k];
    if (vertex < 0) continue;
    // That triangle goes along the side the other way.
    const auto there = std::size_t(other);
    const Foot foot =
        foot_of(on_pattern(there, side + 1), on_pattern(there, side), on_pattern(there, side + 2));
    const Vec3 a = places[k], along = minus(places[(k + 1) % 3], a);
    const Vec3 out = times(Vec3{along[1], -along[0], 0}, foot.height / length(along));
    places[3 + k] = plus(plus(a, times(along, foot.at)), out);
  }
  return places;
}

// Makes hinge k rest as it is where the corner across stands off the triangle's plane.
void curve(RestTriangle& r, std::size_t k, const Places& x, const Vec3& normal, const Foot& own,
           const Foot& away) {
  constexpr double kFlat = 1e-7;  // rad; less is none in single precision
  const Vec3 a = x[k], side = minus(x[(k + 1) % 3], a);
  const auto off = [&](const Vec3& corner, const Foot& foot) {
    return times(minus(minus(corner, a), times(side, foot.at)), 1 / foot.height);
  };
  const Vec3 out = off(x[3 + k], away), in = off(x[(k + 2) % 3], own);
  const double sine = dot(out, normal);
  if (std::abs(sine) < kFlat) return;
  r.own[k] = -dot(out, in) / own.height;
  r.bow[k] = sine / (2 * r.area);
}

// Sets the hinges of a triangle, and returns what their moments are found from.
Plate set_hinges(RestTriangle& r, const Places& x, const std::array<Across, 3>& across,
                 const Vec3& warp, const Vec3& weft, const Vec3& normal, bool flat) {
  Plate plate{r.corner, r.area, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 a = x[k], b = x[(k + 1) % 3];
    const Vec3 out = times(cross(minus(b, a), normal), 1 / r.rest[k]);
    r.away[k] = r.away_at[k] = r.own[k] = r.own_at[k] = r.bow[k] = 0;
    Hinge& h = plate.hinge[k];
    h.length = r.rest[k];
    h.n1 = dot(out, warp);
    h.n2 = dot(out, weft);
    if (across[k].vertex < 0) continue;
    h.across = across[k].triangle;
    h.side = int(across[k].side);
    h.own = foot_of(a, b, x[(k + 2) % 3]);
    h.away = foot_of(a, b, x[3 + k]);
    r.own[k] = 1 / h.own.height;
    r.own_at[k] = h.own.at;
    r.away[k] = 1 / h.away.height;
    r.away_at[k] = h.away.at;
    if (!flat) curve(r, k, x, normal, h.own, h.away);
  }
  return plate;
}

// One triangle as it lies: energy, and the force on its six corners.
struct Pulled {
  double energy = 0;
  std::array<Vec3, 6> force{};
};

struct Corners {
  std::array<Vec3, 6> x{}, v{};
};

void stretch_membrane(const RestTriangle& r, const MeshMaterial& m, const Corners& c, Pulled& p) {
  const auto derivative = [&](const std::array<Vec3, 6>& y, const double(&d)[2]) {
    return plus(times(minus(y[1], y[0]), d[0]), times(minus(y[2], y[0]), d[1]));
  };
  const Vec3 u = derivative(c.x, r.du), w = derivative(c.x, r.dv);
  const Vec3 du = derivative(c.v, r.du), dw = derivative(c.v, r.dv);
  double e11 = 0.5 * (dot(u, u) - 1), e22 = 0.5 * (dot(w, w) - 1), e12 = dot(u, w);
  p.energy += r.area * (0.5 * m.c11 * e11 * e11 + 0.5 * m.c22 * e22 * e22 + m.c12 * e11 * e22 +
                        0.5 * m.c66 * e12 * e12);
  e11 += m.damping * dot(u, du);
  e22 += m.damping * dot(w, dw);
  e12 += m.damping * (dot(u, dw) + dot(du, w));
  const double s11 = m.c11 * e11 + m.c12 * e22, s22 = m.c12 * e11 + m.c22 * e22, s12 = m.c66 * e12;
  const Vec3 a = times(plus(times(u, s11), times(w, s12)), r.area);
  const Vec3 b = times(plus(times(u, s12), times(w, s22)), r.area);
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 pull = plus(times(a, r.du[k]), times(b, r.dv[k]));
    p.force[0] = plus(p.force[0], pull);
    p.force[k + 1] = minus(p.force[k + 1], pull);
  }
}

void stretch_springs(const RestTriangle& r, const MeshMaterial& m, const Corners& c, Pulled& p) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Vec3 e = minus(c.x[next], c.x[k]);
    const double l = std::max(length(e), 1e-10), over = l - r.rest[k];
    p.energy += r.half[k] * (0.5 * m.stiffness * over * over);
    const double rate = dot(e, minus(c.v[next], c.v[k])) / l;
    const Vec3 pull = times(e, r.half[k] * (m.stiffness * over + m.spring_damping * rate) / l);
    p.force[k] = plus(p.force[k], pull);
    p.force[next] = minus(p.force[next], pull);
  }
}

void bend(const RestTriangle& r, const MeshMaterial& m, const Corners& c, Pulled& p) {
  // Jumps of slope of the positions, and how fast they change off the triangle.
  const auto jump = [&](const std::array<Vec3, 6>& y, std::size_t k) {
    const Vec3 side = minus(y[(k + 1) % 3], y[k]);
    const auto off = [&](std::size_t corner, double at, double weight) {
      return times(minus(minus(y[corner], y[k]), times(side, at)), weight);
    };
    return plus(off(3 + k, r.away_at[k], r.away[k]), off((k + 2) % 3, r.own_at[k], r.own[k]));
  };
  const Vec3 p1 = minus(c.x[1], c.x[0]), p2 = minus(c.x[2], c.x[0]), normal = cross(p1, p2);
  const double scale = m.bend_damping / std::max(dot(normal, normal), 1e-30);
  std::array<Vec3, 3> h, felt;
  for (std::size_t k = 0; k < 3; ++k) {
    h[k] = minus(jump(c.x, k), times(normal, r.bow[k]));
    felt[k] = plus(h[k], times(normal, scale * dot(normal, jump(c.v, k))));
  }
  Vec3 turning{};  // what pulls at the product of the sides
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
    const auto moment = [&](const std::array<Vec3, 3>& of) {
      return plus(times(of[k], r.moment[k]),
                  plus(times(of[next], r.moment[3 + k]), times(of[last], r.moment[3 + last])));
    };
    p.energy += 0.5 * dot(h[k], moment(h));
    const Vec3 away = times(moment(felt), r.away[k]), own = times(moment(felt), r.own[k]);
    const Vec3 far = plus(times(away, r.away_at[k]), times(own, r.own_at[k]));
    p.force[3 + k] = minus(p.force[3 + k], away);
    p.force[last] = minus(p.force[last], own);
    p.force[next] = plus(p.force[next], far);
    p.force[k] = plus(p.force[k], minus(plus(away, own), far));
    turning = plus(turning, times(moment(felt), r.bow[k]));
  }
  const Vec3 f1 = cross(p2, turning), f2 = cross(turning, p1);
  p.force[1] = plus(p.force[1], f1);
  p.force[2] = plus(p.force[2], f2);
  p.force[0] = minus(p.force[0], plus(f1, f2));
}

Pulled pulled(const RestTriangle& r, const MeshMaterial& m, const std::vector<Vec3>& x,
              const std::vector<Vec3>* v) {
  Corners c;
  for (std::size_t k = 0; k < 6; ++k) {
    if (r.corner[k] < 0) continue;
    c.x[k] = x[std::size_t(r.corner[k])];
    if (v) c.v[k] = (*v)[std::size_t(r.corner[k])];
  }
  Pulled p;
  m.membrane ? stretch_membrane(r, m, c, p) : stretch_springs(r, m, c, p);
  if (m.bends) bend(r, m, c, p);
  return p;
}

}  // namespace

RestPlaces rest_places(const ClothMesh& mesh) {
  RestPlaces rest{placed_vertices(mesh), mesh.rest == MeshRest::flat, 0};
  if (mesh.rest == MeshRest::uv) rest.uv_scale = mesh.uv_scale;
  if (mesh.rest != MeshRest::file) return rest;
  MeshSource scaled = mesh.at_rest;
  scaled.scale = mesh.scale;
  rest.x = placed_vertices(scaled);
  return rest;
}

bool is_curved(const std::vector<RestTriangle>& triangles) {
  return std::any_of(triangles.begin(), triangles.end(), [](const RestTriangle& r) {
    return r.bow[0] != 0 || r.bow[1] != 0 || r.bow[2] != 0;
  });
}

std::vector<RestTriangle> rest_triangles(const TriangleMesh& mesh, const RestPlaces& rest,
                                         const Bending& bending) {
  const auto across = across_of(mesh);
  std::vector<RestTriangle> all(mesh.triangles.size());
  std::vector<Plate> plates;
  plates.reserve(all.size());
  for (std::size_t t = 0; t < all.size(); ++t) {
    RestTriangle& r = all[t];
    const auto& [a, b, c] = mesh.triangles[t];
    r.corner = {a, b, c, across[t][0].vertex, across[t][1].vertex, across[t][2].vertex};
    const Places x =
        rest.uv_scale > 0 ? places_of(mesh, t, across[t], rest.uv_scale) : places_of(r, rest.x);
    const Vec3 p = minus(x[1], x[0]), q = minus(x[2], x[0]);
    const Vec3 doubled = cross(p, q), normal = times(doubled, 1 / length(doubled));
    const Vec3 warp = warp_of(mesh, t, p, q, normal), weft = cross(normal, warp);
    r.area = 0.5 * length(doubled);
    r.rest[0] = length(p);
    r.rest[1] = length(minus(q, p));
    r.rest[2] = length(q);
    r.half[0] = r.half[1] = r.half[2] = 1;
    // Inverse of the matrix with columns p and q, in the frame of warp and weft.
    const double pu = dot(p, warp), pv = dot(p, weft), qu = dot(q, warp), qv = dot(q, weft);
    const double d = pu * qv - qu * pv;
    r.du[0] = qv / d, r.du[1] = -pv / d;
    r.dv[0] = -qu / d, r.dv[1] = pu / d;
    plates.push_back(
        set_hinges(r, x, across[t], warp, weft, normal, rest.flat || rest.uv_scale > 0));
  }
  if (!bending.given()) return all;
  const auto moments = plate_moments(plates, rest.x.size(), bending);
  for (std::size_t t = 0; t < all.size(); ++t)
    std::copy(moments[t].begin(), moments[t].end(), all[t].moment);
  return all;
}

MeshMaterial material_of(const Cloth& cloth, bool damped_springs) {
  const Membrane& c = cloth.membrane;
  MeshMaterial m{};
  m.membrane = c.given();
  m.bends = cloth.bending.given();
  m.bend_damping = m.bends ? cloth.bending.damping : 0;
  if (m.membrane) {
    m.c11 = c.warp, m.c22 = c.weft, m.c12 = c.coupling, m.c66 = c.shear, m.damping = c.damping;
  } else {
    m.stiffness = cloth.stiffness.structural / 2;
    m.spring_damping = damped_springs ? cloth.spring_damping.structural / 2 : 0;
  }
  return m;
}

MeshMaterial bending_alone(MeshMaterial material) {
  material.membrane = false;
  material.stiffness = 0;
  return material;
}

double mesh_energy(const std::vector<RestTriangle>& triangles, const MeshMaterial& material,
                   const std::vector<Vec3>& x) {
  double sum = 0;
  for (const RestTriangle& r : triangles) sum += pulled(r, material, x, nullptr).energy;
  return sum;
}

void add_mesh_forces(const std::vector<RestTriangle>& triangles, const MeshMaterial& material,
                     const std::vector<Vec3>& x, const std::vector<Vec3>* v,
                     std::vector<Vec3>& forces) {
  for (const RestTriangle& r : triangles) {
    const Pulled p = pulled(r, material, x, v);
    for (std::size_t k = 0; k < 6; ++k)
      if (r.corner[k] >= 0)
        forces[std::size_t(r.corner[k])] = plus(forces[std::size_t(r.corner[k])], p.force[k]);
  }
}

}  // namespace weft::physics
