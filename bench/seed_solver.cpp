#include "seed_solver.h"

#include <algorithm>
#include <cmath>

namespace bench {
namespace {

constexpr float kTimeStep = 1.0f / 60;  // s
constexpr float kDamping = 0.02f;

using Vec = std::array<float, 3>;
Vec operator+(const Vec& a, const Vec& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec operator-(const Vec& a, const Vec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec operator*(float s, const Vec& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
float dot(const Vec& a, const Vec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
float length(const Vec& a) {
  return std::sqrt(dot(a, a));
}

// Where particle (x, y) starts: a curtain that hangs, or level on the sphere's middle.
Vec start_of(const SeedSettings& s, int x, int y) {
  const float across = s.particle_offset * (float(x) - 0.5f * float(s.cloth_dim - 1));
  const float down = s.particle_offset * float(y);
  if (!s.on_sphere) return {across, 6 - down, 0};
  return {across, 6, down - 0.5f * s.particle_offset * float(s.cloth_dim - 1)};
}

}  // namespace

SeedSolver::SeedSolver(const SeedSettings& settings) : settings_(settings) {
  const int dim = settings_.cloth_dim;
  for (int x = 0; x < dim; ++x)
    for (int y = 0; y < dim; ++y) {
      Particle p;
      p.pos = p.old_pos = start_of(settings_, x, y);
      p.movable = !(settings_.pinned && y == 0);
      center_ = center_ + (1.0f / float(dim * dim)) * p.pos;
      particles_.push_back(p);
    }
  sphere_ = {0, 5.8f, 0};
  const float distance = settings_.particle_offset;
  for (int x = 0; x < dim; ++x)
    for (int y = 0; y < dim; ++y)
      for (int i = 1; i <= settings_.constraint_level; ++i) {
        make_constraint(x, y, x + i, y, distance * float(i));
        make_constraint(x, y, x, y + i, distance * float(i));
        make_constraint(x, y, x + i, y + i, distance * std::sqrt(2.0f) * float(i));
      }
}

void SeedSolver::make_constraint(int x, int y, int ox, int oy, float rest) {
  const int dim = settings_.cloth_dim;
  if (ox < dim && oy < dim) constraints_.push_back({x * dim + y, ox * dim + oy, rest});
}

void SeedSolver::satisfy(const Constraint& c) {
  Particle &p1 = particles_[std::size_t(c.p1)], &p2 = particles_[std::size_t(c.p2)];
  const Vec between = p2.pos - p1.pos;
  const float distance = length(between);
  const Vec direction = (1 / distance) * between;
  const Vec correction = (settings_.k * (distance - c.rest_distance)) * direction;
  if (settings_.type == SeedConstraint::positional) {
    if (p1.movable) p1.pos = p1.pos + correction;
    if (p2.movable) p2.pos = p2.pos - correction;
    return;
  }
  Vec force = correction;
  if (settings_.type == SeedConstraint::spring_friction) {
    const Vec v1 = (1 / kTimeStep) * (p1.pos - p1.old_pos),
              v2 = (1 / kTimeStep) * (p2.pos - p2.old_pos);
    force = force + (settings_.u * dot(direction, v2 - v1)) * direction;
  }
  p1.force = p1.force + force;
  p2.force = p2.force - force;
}

void SeedSolver::collide(Particle& p) const {
  if (!settings_.on_sphere || !p.movable) return;
  const Vec out = p.pos - sphere_;
  const float far = radius_ * settings_.offset_multiplier, l = length(out);
  if (l < far) p.pos = p.pos + ((far - l) / l) * out;
}

void SeedSolver::step() {
  for (Particle& p : particles_) {
    p.force = p.force + Vec{0, settings_.gravity * settings_.particle_mass, 0};
    const Vec now = p.pos, acceleration = (1 / settings_.particle_mass) * p.force;
    p.force = {};
    if (!p.movable) continue;
    p.pos =
        (2 - kDamping) * now - (1 - kDamping) * p.old_pos + (kTimeStep * kTimeStep) * acceleration;
    p.old_pos = now;
  }
  for (int n = 0; n < settings_.constraint_iterations; ++n)
    for (const Constraint& c : constraints_) satisfy(c);
  for (int n = 0; n < settings_.collision_iterations; ++n)
    for (Particle& p : particles_) collide(p);
}

double SeedSolver::stretch() const {
  double most = 0;
  for (const Constraint& c : constraints_) {
    const double l = length(particles_[std::size_t(c.p2)].pos - particles_[std::size_t(c.p1)].pos);
    if (!std::isfinite(l)) return l;
    most = std::max(most, l / c.rest_distance);
  }
  return most;
}

double SeedSolver::spread() const {
  double most = 0;
  for (const Particle& p : particles_) most = std::max(most, double(length(p.pos - center_)));
  return most;
}

weft::Scene scene_of(const SeedSettings& s) {
  weft::Scene scene;
  scene.gravity = {0, double(s.gravity), 0};
  scene.time = {1.0 / 60, s.type == SeedConstraint::positional ? 1 : weft::kAutoSubsteps, 5};
  scene.solver.iterations = s.constraint_iterations;
  scene.solver.iterate_springs = true;
  scene.solver.collision_iterations = s.collision_iterations;
  weft::Cloth cloth;
  const double side = double(s.particle_offset) * (s.cloth_dim - 1);
  cloth.grid.nx = cloth.grid.ny = s.cloth_dim;
  cloth.grid.origin = {-side / 2, 6, s.on_sphere ? -side / 2 : 0};
  cloth.grid.u = {side, 0, 0};
  cloth.grid.v = s.on_sphere ? weft::Vec3{0, 0, side} : weft::Vec3{0, -side, 0};
  cloth.particle_mass = double(s.particle_mass);
  cloth.level = s.constraint_level;
  cloth.level_diagonals = weft::LevelDiagonals::one;
  cloth.drag = double(kDamping) * 60;
  if (s.type == SeedConstraint::positional) {
    scene.solver.method = weft::Method::positional;
    cloth.positional_k = double(s.k);
    cloth.stiffness = {1000, 0, 0};
  } else {
    cloth.stiffness = {double(s.k), 0, 0};
    if (s.type == SeedConstraint::spring_friction) {
      scene.solver.method = weft::Method::spring_friction;
      cloth.spring_damping = {double(s.u), 0, 0};
    }
  }
  for (int i = 0; s.pinned && i < s.cloth_dim; ++i) cloth.pins.push_back({i, 0, {}});
  scene.cloths.push_back(cloth);
  if (s.on_sphere) {
    weft::Collider ball;
    ball.shape = weft::Sphere{{0, 5.8, 0}, 0.8};
    ball.offset = 0.8 * (double(s.offset_multiplier) - 1);
    scene.colliders.push_back(ball);
  }
  return scene;
}

}  // namespace bench
