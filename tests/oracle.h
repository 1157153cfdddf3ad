// The equations of motion once more, in double precision, as objects and plain loops: what the
// kernels, rows, colours and wavefront of the library must come out at. Written from the public
// scene alone; nothing of core/physics is used here.
//
//   spring, spring_friction   v <- c v + dt (f/m + g), x <- x + dt v, v half a substep behind
//   positional, compliant     x' <- x; v <- c v + dt g; x <- x + dt v; sweeps; v <- (x - x')/dt
//   C = |e| - l, Δλ = -(C + α λ)/(w_a + w_b + α), α = 1/(k dt²)
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "double_vector.h"
#include "weft/simulation.h"

namespace weft::oracle {

struct Particle {
  Vec3 x{}, v{}, before{};
  double w = 0;  // 1/kg, 0 = pinned
  Vec3 sum{};    // forces, or corrections of a Jacobi sweep
};

struct Link {
  int a, b;
  bool structural_or_shear;
  double rest, k, damping, lambda = 0;
};

// Links that share an offset. A Gauss–Seidel sweep goes along the rows first, both colours of an
// offset in turn, then by row offset and colour through the groups.
struct Group {
  int di, dj;
  std::vector<Link> colour[2];
};

class Cloth {
 public:
  Cloth(const Scene& scene, const std::vector<double>& positions)
      : scene_(scene), cloth_(scene.cloths[0]) {
    const Grid& g = cloth_.grid;
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        Particle p;
        const std::size_t n = 3 * particles.size();
        p.x = {positions[n], positions[n + 1], positions[n + 2]};
        p.w = 1 / particle_mass(cloth_, i, j);
        particles.push_back(p);
      }
    for (const Pin& pin : cloth_.pins) at(pin.i, pin.j).w = 0;
    const Kinds &k = cloth_.stiffness, &d = cloth_.spring_damping;
    if (cloth_.level == 0) {
      add(1, 0, k.structural, d.structural, true);
      add(0, 1, k.structural, d.structural, true);
      add(1, 1, k.shear, d.shear, true);
      add(-1, 1, k.shear, d.shear, true);
      add(2, 0, k.bend, d.bend, false);
      add(0, 2, k.bend, d.bend, false);
    }
    for (int n = 1; n <= cloth_.level; ++n)
      for (const auto& [di, dj] : {std::pair{n, 0}, {0, n}, {n, n}, {-n, n}})
        add(di, dj, k.structural, d.structural, n == 1);
  }

  // Velocities at the time of the positions.
  void set_velocities(const std::vector<double>& v) {
    for (std::size_t p = 0; p < particles.size(); ++p)
      for (std::size_t c = 0; c < 3; ++c) particles[p].v[c] = particles[p].w > 0 ? v[3 * p + c] : 0;
    if (has_forces()) shift_velocities(-0.5 * dt());
  }
  std::vector<Vec3> velocities() {
    const std::vector<Particle> kept = particles;
    if (has_forces()) shift_velocities(0.5 * dt());
    std::vector<Vec3> all;
    for (const Particle& p : particles) all.push_back(p.v);
    particles = kept;
    return all;
  }

  void substep() {
    time_ += dt();
    if (has_forces()) {
      add_forces();
      for (Particle& p : particles) move(p, p.w * p.sum);
      move_pins();
    } else {
      for (Particle& p : particles) {
        p.before = p.x;
        move(p, {});
      }
      move_pins();
      for (Group& g : groups)
        for (auto& colour : g.colour)
          for (Link& link : colour) link.lambda = 0;
      for (int n = 0; n < scene_.solver.iterations; ++n)
        scene_.solver.sweep == Sweep::jacobi ? jacobi() : gauss_seidel();
      for (Particle& p : particles) p.v = (1 / dt()) * (p.x - p.before);
    }
    if (cloth_.strain_limit > 0) limit_strain();
  }

  std::vector<Particle> particles;
  std::vector<Group> groups;

 private:
  double dt() const { return scene_.time.frame / scene_.time.substeps; }
  bool has_forces() const {
    return scene_.solver.method == Method::spring ||
           scene_.solver.method == Method::spring_friction;
  }
  bool damped() const { return scene_.solver.method == Method::spring_friction; }
  Particle& at(int i, int j) {
    return particles[std::size_t(j) * std::size_t(cloth_.grid.nx) + std::size_t(i)];
  }

  void add(int di, int dj, double stiffness, double damping, bool structural_or_shear) {
    const Grid& g = cloth_.grid;
    if (stiffness <= 0) return;
    Group group{di, dj, {}};
    const Vec3 edge = (double(di) / (g.nx - 1)) * g.u + (double(dj) / (g.ny - 1)) * g.v;
    for (int j = 0; j + dj < g.ny; ++j)
      for (int i = std::max(0, -di); i < g.nx && i + di < g.nx; ++i) {
        double factor = 1 - cloth_.stiffness_gradient * (j + 0.5 * dj) / (g.ny - 1);
        if (cloth_.lumping == Lumping::area &&
            ((dj == 0 && (j == 0 || j == g.ny - 1)) || (di == 0 && (i == 0 || i == g.nx - 1))))
          factor /= 2;
        const Link link{j * g.nx + i, (j + dj) * g.nx + i + di, structural_or_shear,
                        length(edge), stiffness * factor,       damping * factor};
        group.colour[(dj > 0 ? j / dj : i / di) % 2].push_back(link);
      }
    if (!group.colour[0].empty()) groups.push_back(group);
  }

  template <class Visit>
  void each_link(Visit&& visit) {
    for (Group& g : groups)
      for (auto& colour : g.colour)
        for (Link& link : colour)
          visit(link, particles[std::size_t(link.a)], particles[std::size_t(link.b)]);
  }

  void add_forces() {
    for (Particle& p : particles) p.sum = {};
    each_link([&](const Link& s, Particle& a, Particle& b) {
      const Vec3 e = b.x - a.x, n = (1 / length(e)) * e;
      double f = s.k * (length(e) - s.rest);
      if (damped()) f += s.damping * dot(n, b.v - a.v);
      a.sum = a.sum + f * n;
      b.sum = b.sum - f * n;
    });
  }
  void shift_velocities(double by) {
    add_forces();
    for (Particle& p : particles)
      if (p.w > 0) p.v = p.v + by * (p.w * p.sum + scene_.gravity);
  }
  void move(Particle& p, const Vec3& acceleration) {
    if (p.w == 0) return;
    // From velocities at the start, unless shifted, to half a substep on.
    const double kick = !has_forces() && time_ < 1.5 * dt() ? 0.5 * dt() : dt();
    p.v = std::max(0.0, 1 - kick * cloth_.drag) * p.v + kick * (acceleration + scene_.gravity);
    p.x = p.x + dt() * p.v;
  }
  // Pins whose two keys lie at the run's start and end.
  void move_pins() {
    for (const Pin& pin : cloth_.pins) {
      if (pin.keys.empty()) continue;
      const Key &a = pin.keys[0], &b = pin.keys[1];
      Particle& p = at(pin.i, pin.j);
      p.v = (1 / (b.time - a.time)) * (b.position - a.position);
      p.x = a.position + (time_ - a.time) * p.v;
    }
  }

  // The step along the link, positive when it is too long, that its multiplier falls by.
  double solve(Link& link, double share, const Particle& a, const Particle& b) const {
    const bool compliant = scene_.solver.method == Method::compliant;
    const double alpha = compliant ? 1 / (link.k * dt() * dt()) : 0;
    if (a.w + b.w + alpha == 0) return 0;
    const double violation = length(b.x - a.x) - link.rest + alpha * link.lambda;
    const double step = violation / ((a.w + b.w) / share + alpha);
    link.lambda -= step;
    return step;
  }
  double share() const {
    return scene_.solver.method == Method::positional ? 2 * cloth_.positional_k : 1;
  }
  // Links in the order of a Gauss–Seidel sweep.
  template <class Visit>
  void each_link_in_sweep(Visit&& visit) {
    const auto take = [&](std::vector<Link>& links) {
      for (Link& link : links)
        visit(link, particles[std::size_t(link.a)], particles[std::size_t(link.b)]);
    };
    for (Group& g : groups)
      if (g.dj == 0)
        for (auto& colour : g.colour) take(colour);
    for (int dj = 1; dj < cloth_.grid.ny; ++dj)
      for (int colour : {0, 1})
        for (Group& g : groups)
          if (g.dj == dj) take(g.colour[colour]);
  }
  void gauss_seidel() {
    each_link_in_sweep([&](Link& link, Particle& a, Particle& b) {
      const Vec3 e = b.x - a.x, n = (1 / length(e)) * e;
      const double step = solve(link, share(), a, b);
      a.x = a.x + (a.w * step) * n;
      b.x = b.x - (b.w * step) * n;
    });
  }
  // ω of a Jacobi sweep: a little under what keeps (1 - ω λ)^sweeps above -1/3 for the largest
  // eigenvalue, relative to the diagonal, of a sheet that resists in all directions (angles in
  // steps of pi/32, both numbers to a 256th).
  double relaxation() const {
    double largest = 1;
    for (int m = 0; m <= 32; ++m)
      for (int n = -32; n <= 32; ++n) {
        double sum = 0;
        for (const Group& g : groups)
          sum += 1 - std::cos((m * g.di + n * g.dj) * std::acos(-1.0) / 32);
        largest = std::max(largest, sum);
      }
    const int sweeps = scene_.solver.iterations;
    const double limit = sweeps % 2 == 0 ? 2 : 1 + std::pow(3, -1.0 / sweeps);
    return 0.95 * std::floor(256 * limit + 1e-6) / std::ceil(256 * largest - 1e-6);
  }
  void jacobi() {
    if (relaxation_ == 0) relaxation_ = relaxation();
    for (Particle& p : particles) p.sum = {};
    each_link([&](Link& link, Particle& a, Particle& b) {
      const Vec3 e = b.x - a.x, n = (1 / length(e)) * e;
      const double step = solve(link, share() * relaxation_, a, b);
      a.sum = a.sum + (a.w * step) * n;
      b.sum = b.sum - (b.w * step) * n;
    });
    for (Particle& p : particles) p.x = p.x + p.sum;
  }
  // No structural or shear link longer than its limit; velocities follow the positions.
  void limit_strain() {
    each_link_in_sweep([&](const Link& link, Particle& a, Particle& b) {
      if (!link.structural_or_shear) return;
      const Vec3 e = b.x - a.x;
      const double excess = length(e) - link.rest * (1 + cloth_.strain_limit);
      if (excess <= 0 || a.w + b.w == 0) return;
      const Vec3 step = (excess / (a.w + b.w) / length(e)) * e;
      a.x = a.x + a.w * step;
      b.x = b.x - b.w * step;
      a.v = a.v + (a.w / dt()) * step;
      b.v = b.v - (b.w / dt()) * step;
    });
  }
  const Scene& scene_;
  const weft::Cloth& cloth_;
  double time_ = 0;
  double relaxation_ = 0;
};

}  // namespace weft::oracle
