// The curvature energy in double precision (bending.h).
#include "physics/model/lattice/bending.h"

namespace weft::physics {
namespace {

// Σ coefficient x of one term.
Vec3 difference(const std::vector<Vec3>& x, int n, const int* particles, const double* factor) {
  Vec3 d{};
  for (int q = 0; q < n; ++q)
    for (int c = 0; c < 3; ++c) d[c] += factor[q] * x[particles[q]][c];
  return d;
}

}  // namespace

BendLinks::BendLinks(const Lattice& l)
    : stride(l.stride),
      along(l.inverse_mass.size()),
      across(l.inverse_mass.size()),
      twist(l.inverse_mass.size()) {
  make_whole();
}

void BendLinks::make_whole() {
  for (auto* terms : {&along, &across, &twist}) std::fill_n(terms->data(), terms->size(), 1.0f);
}

BendingStiffness bending_stiffness(const Cloth& cloth) {
  const Grid& g = cloth.grid;
  const double hu = spacing_u(g), hv = spacing_v(g);
  const double area = hu * hv;
  const Bending& d = cloth.bending;
  if (lumps_by_area(cloth))
    return {d.warp * area / (hu * hu * hu * hu), d.weft * area / (hv * hv * hv * hv),
            2 * d.twist / area};
  return {d.warp * area * (g.ny - 1) / g.ny / (hu * hu * hu * hu),
          d.weft * area * (g.nx - 1) / g.nx / (hv * hv * hv * hv), 2 * d.twist / area};
}

double bending_energy(const Cloth& cloth, const std::vector<Vec3>& x, const BendLinks* left) {
  double energy = 0;
  const auto add = [&](double k, int n, const int* particles, const double* factor) {
    const Vec3 d = difference(x, n, particles, factor);
    energy += 0.5 * k * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  };
  if (cloth.bending.given()) for_each_bend(cloth, add, left);
  return energy;
}

}  // namespace weft::physics
