// Velocity Verlet in double precision (verlet.h). Plain loops over whole arrays, which the compiler
// turns into vectors; the two loops that take the time are built for several instruction sets.
#include "verlet.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace bench {
namespace {

#define WEFT_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))

// e <- k (1 - l/|b - a|) (b - a), the force on a, for `count` springs of their shares of k.
WEFT_CLONES void spring_row(int count, double k, const double* __restrict share, double rest,
                            const double* __restrict ax, const double* __restrict ay,
                            const double* __restrict az, const double* __restrict bx,
                            const double* __restrict by, const double* __restrict bz,
                            double* __restrict ex, double* __restrict ey, double* __restrict ez) {
  for (int i = 0; i < count; ++i) {
    const double dx = bx[i] - ax[i], dy = by[i] - ay[i], dz = bz[i] - az[i];
    const double s = k * share[i] * (1 - rest / std::sqrt(dx * dx + dy * dy + dz * dz));
    ex[i] = s * dx;
    ey[i] = s * dy;
    ez[i] = s * dz;
  }
}

WEFT_CLONES void add(int count, const double* __restrict e, double* __restrict f) {
  for (int i = 0; i < count; ++i) f[i] += e[i];
}

WEFT_CLONES void subtract(int count, const double* __restrict e, double* __restrict f) {
  for (int i = 0; i < count; ++i) f[i] -= e[i];
}

// Half a kick, drag, half a kick, drift; the force is cleared for the next step.
WEFT_CLONES void move_component(std::size_t n, double h, double keep,
                                const double* __restrict inverse_mass, const double* __restrict g,
                                double* __restrict f, double* __restrict v, double* __restrict x) {
  for (std::size_t i = 0; i < n; ++i) {
    const double half = 0.5 * h * (f[i] * inverse_mass[i] + g[i]);
    v[i] = (v[i] + half) * keep + half;
    x[i] += h * v[i];
    f[i] = 0;
  }
}

double norm(const weft::Vec3& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double rest_length(const weft::Grid& g, int di, int dj) {
  weft::Vec3 e;
  for (std::size_t c = 0; c < 3; ++c) e[c] = g.u[c] * di / (g.nx - 1) + g.v[c] * dj / (g.ny - 1);
  return norm(e);
}

std::vector<Springs> springs_of(const weft::Cloth& cloth) {
  std::vector<Springs> all;
  if (cloth.membrane.given()) return all;
  const weft::Grid& g = cloth.grid;
  const auto stencil = [&](int di, int dj, double k) {
    if (k <= 0 || std::abs(di) >= g.nx || dj >= g.ny) return;
    Springs s{
        std::max(0, -di), std::max(0, di), dj, g.nx - std::abs(di), rest_length(g, di, dj), {}, {}};
    for (int j = 0; j + dj < g.ny; ++j)
      s.stiffness.push_back(k * (1 - cloth.stiffness_gradient * (j + 0.5 * dj) / (g.ny - 1)) *
                            (dj == 0 ? weft::width_share(cloth, 0, j, di, 0) : 1));
    for (int a = 0; a < s.count; ++a)
      s.share.push_back(di == 0 ? weft::width_share(cloth, a, 0, 0, dj) : 1);
    all.push_back(std::move(s));
  };
  if (cloth.level == 0) {
    for (const auto& [di, dj] : {std::pair{1, 0}, {0, 1}})
      stencil(di, dj, cloth.stiffness.structural);
    for (const auto& [di, dj] : {std::pair{1, 1}, {-1, 1}}) stencil(di, dj, cloth.stiffness.shear);
    for (const auto& [di, dj] : {std::pair{2, 0}, {0, 2}}) stencil(di, dj, cloth.stiffness.bend);
  }
  for (int n = 1; n <= cloth.level; ++n)
    for (const auto& [di, dj] : {std::pair{n, 0}, {0, n}, {n, n}, {-n, n}})
      if (di >= 0 || cloth.level_diagonals == weft::LevelDiagonals::both)
        stencil(di, dj, cloth.stiffness.structural);
  return all;
}

// A particle below a surface is put onto it; its velocity loses the part into the surface and, by
// Coulomb's law, as much of the part along it as what it loses allows.
void touch(const weft::Friction& friction, double depth, double h, const weft::Vec3& n,
           weft::Vec3& x, weft::Vec3& v) {
  double into = 0, along = 0;
  for (std::size_t c = 0; c < 3; ++c) into += v[c] * n[c];
  weft::Vec3 t;
  for (std::size_t c = 0; c < 3; ++c) t[c] = v[c] - into * n[c];
  along = norm(t);
  const double lost = std::max(0.0, -into);
  const bool sticks = along <= friction.statik * lost;
  const double keep = sticks || along == 0 ? 0 : std::max(0.0, 1 - friction.dynamic * lost / along);
  for (std::size_t c = 0; c < 3; ++c) {
    x[c] += depth * n[c] + (keep - 1) * t[c] * h;
    v[c] = keep * t[c] + std::max(0.0, into) * n[c];
  }
}

}  // namespace

Verlet::Verlet(const weft::Scene& scene)
    : scene_(scene),
      columns_(scene.cloths[0].grid.nx),
      rows_(scene.cloths[0].grid.ny),
      particles_(std::size_t(columns_) * std::size_t(rows_)),
      springs_(springs_of(scene.cloths[0])),
      hu_(weft::spacing_u(scene.cloths[0].grid)),
      hv_(weft::spacing_v(scene.cloths[0].grid)) {
  const weft::Cloth& cloth = scene_.cloths[0];
  const weft::Grid& g = cloth.grid;
  for (auto* a : {&x_, &y_, &z_, &vx_, &vy_, &vz_, &fx_, &fy_, &fz_, &inverse_mass_})
    a->assign(particles_, 0.0);
  gx_.assign(particles_, scene.gravity[0]);
  gy_.assign(particles_, scene.gravity[1]);
  gz_.assign(particles_, scene.gravity[2]);
  for (auto* a : {&ex_, &ey_, &ez_}) a->resize(std::size_t(columns_));
  std::size_t p = 0;
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i, ++p) {
      const double s = double(i) / (g.nx - 1), t = double(j) / (g.ny - 1);
      x_[p] = g.origin[0] + g.u[0] * s + g.v[0] * t;
      y_[p] = g.origin[1] + g.u[1] * s + g.v[1] * t;
      z_[p] = g.origin[2] + g.u[2] * s + g.v[2] * t;
      inverse_mass_[p] = 1 / weft::particle_mass(cloth, i, j);
    }
  for (const weft::Pin& pin : cloth.pins) {
    p = std::size_t(pin.j) * std::size_t(columns_) + std::size_t(pin.i);
    inverse_mass_[p] = gx_[p] = gy_[p] = gz_[p] = 0;
  }
  moved_ = moving_pins(cloth);
}

double Verlet::safe_step() const {
  // Every spring at a particle adds its stiffness to the particle's own block of K and once more
  // beside it.
  std::vector<double> k(particles_, 0.0);
  for (const Springs& s : springs_)
    for (int j = 0; j + s.dj < rows_; ++j)
      for (int a = 0; a < s.count; ++a) {
        const double stiffness = s.stiffness[std::size_t(j)] * s.share[std::size_t(a)];
        k[std::size_t(j * columns_ + a + s.near)] += 2 * stiffness;
        k[std::size_t((j + s.dj) * columns_ + a + s.far)] += 2 * stiffness;
      }
  // Every curvature adds w (Σ |w|) times its stiffness; the strains of a cell less than this at its corners.
  for_each_curvature([&](const double* w, int count, const std::size_t* at, double stiffness) {
    double sum = 0;
    for (int n = 0; n < count; ++n) sum += std::abs(w[n]);
    for (int n = 0; n < count; ++n) k[at[n]] += stiffness * std::abs(w[n]) * sum;
  });
  const weft::Membrane& m = scene_.cloths[0].membrane;
  const double cell = m.warp * hv_ / hu_ + m.weft * hu_ / hv_ + 2 * std::abs(m.coupling) +
                      m.shear * (hv_ / hu_ + hu_ / hv_ + 2) / 2;
  for (int j = 0; j + 1 < rows_ && m.given(); ++j)
    for (int i = 0; i + 1 < columns_; ++i)
      for (const int corner : {0, 1, columns_, columns_ + 1})
        k[std::size_t(j * columns_ + i + corner)] += cell;
  double omega_squared = 0;
  for (std::size_t p = 0; p < particles_; ++p)
    omega_squared = std::max(omega_squared, k[p] * inverse_mass_[p]);
  return omega_squared > 0 ? 2 / std::sqrt(omega_squared) : 1e-2;
}

void Verlet::spring_forces(const Springs& s) {
  for (int j = 0; j + s.dj < rows_; ++j) {
    const std::size_t a = std::size_t(j * columns_ + s.near);
    const std::size_t b = std::size_t((j + s.dj) * columns_ + s.far);
    spring_row(s.count, s.stiffness[std::size_t(j)], s.share.data(), s.rest, &x_[a], &y_[a], &z_[a],
               &x_[b], &y_[b], &z_[b], ex_.data(), ey_.data(), ez_.data());
    add(s.count, ex_.data(), &fx_[a]);
    add(s.count, ey_.data(), &fy_[a]);
    add(s.count, ez_.data(), &fz_[a]);
    subtract(s.count, ex_.data(), &fx_[b]);
    subtract(s.count, ey_.data(), &fy_[b]);
    subtract(s.count, ez_.data(), &fz_[b]);
  }
}

// E = hu hv Σ cells [C11 (e² + e'²)/4 + C22 (f² + f'²)/4 + C12 (e + e')(f + f')/4 + C66 γ²/2], with the strains
// e = (a·a/hu² - 1)/2 of its sides along u, f likewise, and γ = (a + a')·(b + b')/(4 hu hv).
void Verlet::membrane_forces() {
  const weft::Membrane& m = scene_.cloths[0].membrane;
  const double uu = 1 / (hu_ * hu_), vv = 1 / (hv_ * hv_), area = hu_ * hv_;
  for (int j = 0; j + 1 < rows_; ++j)
    for (int i = 0; i + 1 < columns_; ++i) {
      const std::size_t p[4] = {std::size_t(j * columns_ + i), std::size_t(j * columns_ + i + 1),
                                std::size_t((j + 1) * columns_ + i),
                                std::size_t((j + 1) * columns_ + i + 1)};
      double a[2][3], b[2][3], across[3], down[3];
      double aa[2] = {}, bb[2] = {}, ab = 0;
      for (int c = 0; c < 3; ++c) {
        const std::vector<double>& x = c == 0 ? x_ : c == 1 ? y_ : z_;
        for (int n = 0; n < 2; ++n) {
          a[n][c] = x[p[2 * n + 1]] - x[p[2 * n]];
          b[n][c] = x[p[n + 2]] - x[p[n]];
          aa[n] += a[n][c] * a[n][c];
          bb[n] += b[n][c] * b[n][c];
        }
        across[c] = a[0][c] + a[1][c];
        down[c] = b[0][c] + b[1][c];
        ab += across[c] * down[c];
      }
      double e[2], f[2];
      for (int n = 0; n < 2; ++n) e[n] = (aa[n] * uu - 1) / 2, f[n] = (bb[n] * vv - 1) / 2;
      const double slant = m.shear * ab / (16 * area);
      for (int c = 0; c < 3; ++c) {
        std::vector<double>& force = c == 0 ? fx_ : c == 1 ? fy_ : fz_;
        for (int n = 0; n < 2; ++n) {
          const double along =
              area * uu * (m.warp * e[n] + m.coupling * (f[0] + f[1]) / 2) / 2 * a[n][c] +
              slant * down[c];
          force[p[2 * n]] += along;
          force[p[2 * n + 1]] -= along;
          const double beside =
              area * vv * (m.weft * f[n] + m.coupling * (e[0] + e[1]) / 2) / 2 * b[n][c] +
              slant * across[c];
          force[p[n]] += beside;
          force[p[n + 2]] -= beside;
        }
      }
    }
}

// Curvatures along u and v at every point between two others, of the width that it stands for; twists of cells.
template <class Visit>
void Verlet::for_each_curvature(Visit&& visit) const {
  const weft::Bending& bending = scene_.cloths[0].bending;
  if (!bending.given()) return;
  constexpr double kLine[] = {1, -2, 1}, kTwist[] = {1, -1, -1, 1};
  const auto width = [](int line, int lines) { return line == 0 || line == lines - 1 ? 0.5 : 1; };
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) {
      const auto at = [&](int di, int dj) { return std::size_t((j + dj) * columns_ + i + di); };
      if (i > 0 && i + 1 < columns_) {
        const std::size_t p[] = {at(-1, 0), at(0, 0), at(1, 0)};
        visit(kLine, 3, p, bending.warp * width(j, rows_) * hv_ / (hu_ * hu_ * hu_));
      }
      if (j > 0 && j + 1 < rows_) {
        const std::size_t p[] = {at(0, -1), at(0, 0), at(0, 1)};
        visit(kLine, 3, p, bending.weft * width(i, columns_) * hu_ / (hv_ * hv_ * hv_));
      }
      if (i + 1 < columns_ && j + 1 < rows_) {
        const std::size_t p[] = {at(0, 0), at(1, 0), at(0, 1), at(1, 1)};
        visit(kTwist, 4, p, 2 * bending.twist / (hu_ * hv_));
      }
    }
}

void Verlet::bending_forces() {
  for_each_curvature([&](const double* w, int count, const std::size_t* at, double stiffness) {
    for (const auto& [x, f] : {std::pair{&x_, &fx_}, {&y_, &fy_}, {&z_, &fz_}}) {
      double sum = 0;
      for (int n = 0; n < count; ++n) sum += w[n] * (*x)[at[n]];
      for (int n = 0; n < count; ++n) (*f)[at[n]] -= stiffness * w[n] * sum;
    }
  });
}

void Verlet::forces() {
  for (const Springs& s : springs_) spring_forces(s);
  if (scene_.cloths[0].membrane.given()) membrane_forces();
  bending_forces();
}

void Verlet::move(double h, double keep) {
  move_component(particles_, h, keep, inverse_mass_.data(), gx_.data(), fx_.data(), vx_.data(),
                 x_.data());
  move_component(particles_, h, keep, inverse_mass_.data(), gy_.data(), fy_.data(), vy_.data(),
                 y_.data());
  move_component(particles_, h, keep, inverse_mass_.data(), gz_.data(), fz_.data(), vz_.data(),
                 z_.data());
}

void Verlet::contact(double h) {
  for (const weft::Collider& collider : scene_.colliders)
    for (std::size_t p = 0; p < particles_; ++p) {
      if (inverse_mass_[p] == 0) continue;
      weft::Vec3 x{x_[p], y_[p], z_[p]}, v{vx_[p], vy_[p], vz_[p]}, n{};
      double depth = 0;
      if (const auto* sphere = std::get_if<weft::Sphere>(&collider.shape)) {
        for (std::size_t c = 0; c < 3; ++c) n[c] = x[c] - sphere->center[c];
        const double r = norm(n);
        for (double& c : n) c /= r;
        depth = sphere->radius + collider.offset - r;
      } else if (const auto* plane = std::get_if<weft::Plane>(&collider.shape)) {
        const double length = norm(plane->normal);
        depth = collider.offset;
        for (std::size_t c = 0; c < 3; ++c) {
          n[c] = plane->normal[c] / length;
          depth -= (x[c] - plane->point[c]) * n[c];
        }
      }
      if (depth <= 0) continue;
      touch(collider.friction, depth, h, n, x, v);
      x_[p] = x[0], y_[p] = x[1], z_[p] = x[2];
      vx_[p] = v[0], vy_[p] = v[1], vz_[p] = v[2];
    }
}

void Verlet::move_pins(double time) {
  for (const Held& held : moved_) {
    const weft::Vec3 at = place_of(held, time);
    x_[held.particle] = at[0], y_[held.particle] = at[1], z_[held.particle] = at[2];
  }
}

void Verlet::advance(double seconds, std::int64_t steps) {
  const double h = seconds / double(steps);
  const double drag = scene_.cloths[0].drag;
  // The first step starts from rest: its second half kick is the only one, which leaves the
  // velocity at half a step.
  forces();
  for (auto* f : {&fx_, &fy_, &fz_})
    for (double& c : *f) c *= 0.5;
  for (auto* g : {&gx_, &gy_, &gz_})
    for (double& c : *g) c *= 0.5;
  move(h, 1);
  for (auto* g : {&gx_, &gy_, &gz_})
    for (double& c : *g) c *= 2;
  move_pins(h);
  contact(h);
  const double keep = std::exp(-drag * h);
  for (std::int64_t n = 1; n < steps; ++n) {
    forces();
    move(h, keep);
    move_pins(double(n + 1) * h);
    contact(h);
  }
}

double Verlet::largest_acceleration() const {
  double most = 0;
  for (std::size_t p = 0; p < particles_; ++p) {
    const double w = inverse_mass_[p];
    most = std::max({most, std::abs(fx_[p] * w + gx_[p]), std::abs(fy_[p] * w + gy_[p]),
                     std::abs(fz_[p] * w + gz_[p])});
  }
  return most;
}

void Verlet::come_to_rest(double acceleration) {
  constexpr std::int64_t kMostSteps = 2'000'000;
  constexpr double kDrag = 4;  // 1/s; critical for the slowest modes of a hanging metre of cloth
  const double h = 0.7 * safe_step(), keep = std::exp(-kDrag * h);
  for (std::int64_t n = 0; n < kMostSteps; ++n) {
    forces();
    if (n % 1000 == 0 && largest_acceleration() < acceleration) break;
    move(h, keep);
  }
  for (auto* f : {&fx_, &fy_, &fz_}) f->assign(particles_, 0.0);
}

std::vector<double> Verlet::positions() const {
  std::vector<double> all;
  all.reserve(3 * particles_);
  for (std::size_t p = 0; p < particles_; ++p) all.insert(all.end(), {x_[p], y_[p], z_[p]});
  return all;
}

}  // namespace bench
