// Forces of triangles. With u and v the derivatives of position along warp and weft, Green's strain is
// e11 = (u·u - 1)/2, e22 = (v·v - 1)/2, 2 e12 = u·v, and stress s = C (e + damping ė): a polynomial, no root
// and no division. Or springs along the sides, half of each for each triangle that it has. Bending is a
// quadratic form of the hinges: how far neighbours lie off the triangle's plane, as vectors.
#include "physics/kernels/mesh.h"

#include "physics/kernels/hinges.h"
#include "physics/kernels/leapfrog.h"
#include "physics/kernels/records.h"

namespace weft::WEFT_KERNELS {
namespace {

using physics::MeshBatch;
using physics::MeshForces;
using physics::MeshRow;

constexpr float kTinySquare = 1e-20f;  // m²
constexpr float kTinyArea = 1e-30f;    // m⁴, squared

struct Derivatives {
  Wide3 u, v;
};

// Lanes from `lane` on of one batch.
struct Triangles {
  const MeshForces& m;
  const MeshBatch& b;
  int lane;

  WEFT_INLINE Wide3 at(const float* records, int k) const {
    return records_at(records, 4, b.corner[k] + lane).xyz;
  }
  WEFT_INLINE Derivatives derivatives(const Wide3 (&x)[3]) const {
    const Wide3 p = x[1] - x[0], q = x[2] - x[0];
    return {p * load(b.du[0] + lane) + q * load(b.du[1] + lane),
            p * load(b.dv[0] + lane) + q * load(b.dv[1] + lane)};
  }

  WEFT_INLINE void membrane(const Wide3 (&x)[3], const Wide3 (&v)[3], Wide3 (&f)[3]) const {
    const auto [u, w] = derivatives(x);
    Wide e11 = 0.5f * (dot(u, u) - 1.0f), e22 = 0.5f * (dot(w, w) - 1.0f), e12 = dot(u, w);
    if (m.velocity) {
      const auto [du, dw] = derivatives(v);
      e11 = e11 + m.damping * dot(u, du);
      e22 = e22 + m.damping * dot(w, dw);
      e12 = e12 + m.damping * (dot(u, dw) + dot(du, w));
    }
    const Wide area = load(b.area + lane);
    const Wide s11 = area * (m.c11 * e11 + m.c12 * e22), s22 = area * (m.c12 * e11 + m.c22 * e22);
    const Wide s12 = area * (m.c66 * e12);
    const Wide3 p = u * s11 + w * s12, q = u * s12 + w * s22;
    const Wide3 g = p * load(b.du[0] + lane) + q * load(b.dv[0] + lane);
    const Wide3 h = p * load(b.du[1] + lane) + q * load(b.dv[1] + lane);
    f[0] = f[0] + (g + h);
    f[1] = f[1] - g;
    f[2] = f[2] - h;
  }

  WEFT_INLINE void springs(const Wide3 (&x)[3], const Wide3 (&v)[3], Wide3 (&f)[3]) const {
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const Wide3 e = x[next] - x[k];
      const Wide reciprocal = 1.0f / sqrt(max(dot(e, e), wide(kTinySquare)));
      Wide scale = m.stiffness * (1.0f - load(b.rest[k] + lane) * reciprocal);
      if (m.velocity)
        scale = scale + m.spring_damping * dot(e, v[next] - v[k]) * (reciprocal * reciprocal);
      const Wide3 pull = e * (scale * load(b.half[k] + lane));
      f[k] = f[k] + pull;
      f[next] = f[next] - pull;
    }
  }

  // What a jump becomes off the triangle is damped; that it turns with the triangle is not.
  WEFT_INLINE void add_rates(const Wide3 (&x)[3], const Wide3 (&v)[6], Wide3 (&jump)[3]) const {
    const Wide3 normal = cross(x[1] - x[0], x[2] - x[0]);
    const Wide scale = m.bend_damping / max(dot(normal, normal), wide(kTinyArea));
    Wide3 rate[3];
    Hinges{b, lane}.jumps(v, rate);
    for (int k = 0; k < 3; ++k) jump[k] = jump[k] + normal * (dot(normal, rate[k]) * scale);
  }
};

template <bool kMembrane, bool kBends>
WEFT_INLINE void forces_of(const MeshForces& m) {
  for (int n = 0; n < m.count; ++n)
    for (int lane = 0; lane < physics::kBatch; lane += kLanes) {
      const Triangles t{m, m.batches[n], lane};
      Wide3 x[3], v[3] = {}, f[3] = {};
      for (int k = 0; k < 3; ++k) x[k] = t.at(m.position, k);
      if (m.velocity)
        for (int k = 0; k < 3; ++k) v[k] = t.at(m.velocity, k);
      if constexpr (kMembrane)
        t.membrane(x, v, f);
      else
        t.springs(x, v, f);
      if constexpr (kBends) {
        Wide3 jump[3], across[3];
        const Hinges hinges{t.b, lane};
        hinges.jumps(
            {x[0], x[1], x[2], t.at(m.position, 3), t.at(m.position, 4), t.at(m.position, 5)},
            jump);
        const Wide3 p = x[1] - x[0], q = x[2] - x[0];
        if (m.bows) hinges.take_off_rest(p, q, jump);
        if (m.bend_damping > 0)
          t.add_rates(
              x, {v[0], v[1], v[2], t.at(m.velocity, 3), t.at(m.velocity, 4), t.at(m.velocity, 5)},
              jump);
        hinges.pull(jump, f, across);
        if (m.bows) hinges.turn(jump, p, q, f);
        for (int k = 0; k < 3; ++k) add_records(m.force, 4, t.b.corner[3 + k] + lane, across[k]);
      }
      for (int k = 0; k < 3; ++k) add_records(m.force, 4, t.b.corner[k] + lane, f[k]);
    }
}

}  // namespace

void mesh_load(const MeshRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    put_records(r.position + 4 * std::ptrdiff_t(i), 4, {load3(r.x, i), Wide{}});
    if (r.velocity) put_records(r.velocity + 4 * std::ptrdiff_t(i), 4, {load3(r.v, i), Wide{}});
    put_records(r.force + 4 * std::ptrdiff_t(i), 4, {Wide3{}, Wide{}});
  }
}

void mesh_forces(const MeshForces& m) {
  if (m.membrane)
    m.bends ? forces_of<true, true>(m) : forces_of<true, false>(m);
  else
    m.bends ? forces_of<false, true>(m) : forces_of<false, false>(m);
}

void mesh_move(const MeshRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes)
    move(r.x, r.v, r.left, r.w, records_in_row(r.force + 4 * std::ptrdiff_t(i), 4).xyz, r.advance,
         i);
}

}  // namespace weft::WEFT_KERNELS
