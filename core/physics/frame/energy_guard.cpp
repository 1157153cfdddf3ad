// Counts energies (energy_guard.h). Sums run over the particles in their order, in double.
#include "physics/frame/energy_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/contact/body/body_surface.h"
#include "physics/contact/colliders/shapes.h"
#include "physics/model/path.h"
#include "physics/model/placement.h"

namespace weft::physics {
namespace {

constexpr double kStillness = 0.01;  // m/s; motion that is never looked into
constexpr double kDrivenSpeed = 10;  // m/s; what wind, paths and hands may give besides their own

// Visits all free particles: row, lane, mass.
template <class Visit>
void for_each_free(const Particles& p, Visit&& visit) {
  p.for_each([&](int j, int i) {
    if (const double w = p.w(j, i); w > 0) visit(j, i, 1 / w);
  });
}

// Positions outside of the colliders, where these will have put what lies inside them.
Rows pushed_out(const Scene& scene, double time, const Particles& l) {
  Rows x(l.rows, l.stride);
  x.copy(l.x);
  for (const Collider& c : scene.colliders) {
    if (c.cuts) continue;
    const Placement placement(c, time);
    for_each_free(l, [&](int j, int i, double) {
      const Vec3 p{x.at(0, j, i), x.at(1, j, i), x.at(2, j, i)};
      const Nearest n = nearest_at(c.shape, time, placement.seen(p));
      const Vec3 out = placement.out_of(n.normal);
      for (int k = 0; k < 3 && n.distance < c.offset; ++k)
        x.at(k, j, i) = coordinate(p[k] + (c.offset - n.distance) * out[k]);
    });
  }
  return x;
}

EnergySum motion(const Scene& scene, const ClothStep& step, const Rows& x, const Rows& v) {
  const Particles& l = step.particles();
  EnergySum sum;
  for (int j = 0; j < l.rows; ++j)
    sum += step.parts().kernels.particles.energy_sum(
        energy_row(l, x.row(j), v.row(j), j, EnergyGuard::counted_gravity(scene)));
  return sum;
}

double free_mass(const Particles& l) {
  double mass = 0;
  for_each_free(l, [&](int, int, double m) { mass += m; });
  return mass;
}

bool unbounded(const Collider& c) {
  return std::holds_alternative<Plane>(c.shape);
}

// The greatest speed of paths between two times, and of wind [m/s].
double fastest_drive(const Scene& scene, double from, double to) {
  const auto fastest = [&](const std::vector<Key>& keys) {
    double most = 0;
    for (std::size_t n = 1; n < keys.size(); ++n) {
      if (keys[n].time <= from || keys[n - 1].time >= to) continue;
      const Vec3 e = minus(keys[n].position, keys[n - 1].position);
      most = std::max(most, length(e) / (keys[n].time - keys[n - 1].time));
    }
    return most;
  };
  const auto turning = [&](const Cloth& cloth, const Pin& pin) {
    double most = 0;
    const std::vector<Angle>& keys = pin.rotate.keys;
    for (std::size_t n = 1; n < keys.size(); ++n) {
      if (keys[n].time <= from || keys[n - 1].time >= to) continue;
      const Vec3 r = minus(pin_alone_at(cloth, pin, keys[n].time), pin.rotate.about);
      const double turn = (keys[n].degrees - keys[n - 1].degrees) * std::numbers::pi / 180;
      most = std::max(most, std::abs(turn) * length(r) / (keys[n].time - keys[n - 1].time));
    }
    return most;
  };
  // What has no bounds is looked at where the cloth is (fastest_turning()).
  const auto rim = [&](const Collider& c) {
    const double turn = fastest_turn(c.rotate, from, to);
    return turn == 0 || unbounded(c) ? 0 : turn * lever_of(c, c.rotate.about);
  };
  double most = greatest_wind(scene.wind);
  for (const Collider& c : scene.colliders) {
    const BodySurface* body = surface_of(c);
    most = std::max(most, fastest(c.keys) + (body ? body->fastest(from, to) : 0) + rim(c));
  }
  for (const Cloth& c : scene.cloths)
    for (const Pin& p : c.pins) most = std::max(most, fastest(p.keys) + turning(c, p));
  return most;
}

}  // namespace

double fastest_follower(const ClothStep& step, double from, double to) {
  const ClothModel& model = step.model();
  double most = 0;
  for (const Pin& p : step.cloth().pins)
    if (p.follow >= 0 && to > from)
      most = std::max(
          most, distance(model.pin_position(p, from), model.pin_position(p, to)) / (to - from));
  return most;
}

double fastest_turning(const Scene& scene, const Particles& l, double from, double to) {
  double most = 0;
  for (const Collider& c : scene.colliders) {
    const double turn = fastest_turn(c.rotate, from, to);
    if (turn == 0 || !unbounded(c)) continue;
    const Vec3 about = plus(c.rotate.about, along_keys(c, to));
    const Vec3 axis = times(c.rotate.axis, 1 / length(c.rotate.axis));
    for_each_free(l, [&](int j, int i, double) {
      most = std::max(most, turn * length(cross(axis, minus(l.position(j, i), about))));
    });
  }
  return most;
}

bool gained(const Scene& scene, const ClothStep& step, const Rows& x, const Rows& v, double dt,
            double start, double end, Threads& threads) {
  constexpr double kMore = 2;
  const Particles& l = step.particles();
  const EnergySum before = motion(scene, step, x, v), now = motion(scene, step, l.x, l.v);
  double put_in = std::max(0.0, before.potential - now.potential);
  const double speed =
      kMore * std::max({fastest_drive(scene, start, end), fastest_follower(step, start, end),
                        fastest_turning(scene, l, start, end)});
  if (speed > 0) put_in += 0.5 * free_mass(l) * speed * speed;
  const double inner = now.kinetic + step.model().held_energy(l.x, dt, threads);
  // EnergySum alone accounts for most frames.
  if (inner <= kMore * before.kinetic + put_in) return false;
  return inner > kMore * (before.kinetic + step.model().held_energy(x, dt, threads)) + put_in;
}

Balance balance(const Scene& scene, const ClothStep& step, double dt, Threads& threads) {
  const Particles& l = step.particles();
  const EnergySum now = motion(scene, step, l.x, l.v);
  return {now.kinetic + step.model().held_energy(l.x, dt, threads), now.potential,
          2 * step.cloth().drag * now.kinetic * scene.time.frame};
}

bool works(const Scene& scene, double from, double to) {
  const auto turns = [&](const Collider& c) { return fastest_turn(c.rotate, from, to) > 0; };
  return fastest_drive(scene, from, to) > 0 ||
         std::any_of(scene.colliders.begin(), scene.colliders.end(), turns);
}

bool Upkeep::kept_up(const Balance& now) {
  constexpr double kMore = 2;
  const double all = now.inner + now.potential;
  if (!known_ || all < least_) {
    known_ = true;
    least_ = all;
    inner_ = now.inner;
    lost_ = 0;
    return false;
  }
  lost_ += now.lost;
  return lost_ > kMore * inner_;
}

void EnergyGuard::open(const Scene& scene, Method method, const Cloths& cloths, double time,
                       double dt, Threads& threads) {
  *this = {};
  for (const auto& step : cloths) {
    const Particles& l = step->particles();
    free_mass_ += free_mass(l);
    const auto held = [&](const Rows& x) {
      return step->model().held_energy(x, dt, threads) + step->model().attachment_energy(x, dt);
    };
    put_in_ += std::max(held(l.x), held(pushed_out(scene, time, l)));
    if (const Load* load = step->model().load()) put_in_ += load->reserve();
    if (is_explicit(method))
      rounding_ += step->model().rounding_gain();  // projection loses what it gains
  }
  look(scene, cloths, false);
  highest_ = potential_;
  fall_ = 0;
  put_in_ += kinetic_ + 0.5 * free_mass_ * kStillness * kStillness;
  fastest_ = fastest_drive(scene, 0, std::numeric_limits<double>::infinity());
  gained_ = scene.gravity_keys.empty() ? 0 : greatest_gravity(scene) * scene.time.frame;
  fastest_ += gained_;
}

Vec3 EnergyGuard::counted_gravity(const Scene& scene) {
  return scene.gravity_keys.empty() ? scene.gravity : Vec3{};
}

void EnergyGuard::drive(double speed) {
  fastest_ = std::max(fastest_, speed);
}

void EnergyGuard::look(const Scene& scene, const Cloths& cloths, bool driven) {
  EnergySum all;
  for (const auto& step : cloths)
    all += motion(scene, *step, step->particles().x, step->particles().v);
  look(all, driven);
}

void EnergyGuard::look(const EnergySum& all, bool driven) {
  driven_ = driven;
  kinetic_ = all.kinetic;
  potential_ = all.potential;
  fall_ = std::max(released_, highest_ - potential_);
}

void EnergyGuard::accept(int substeps) {
  begins_ = false;
  highest_ = std::max(highest_, potential_);
  released_ = fall_;
  put_in_ += substeps * rounding_;
  fastest_ += gained_;
}

double EnergyGuard::reduction() const {
  return std::sqrt(bound() / kinetic_);
}

double EnergyGuard::bound() const {
  const double kept = put_in_ + fall_, speed = kDrivenSpeed + fastest_;
  return kBound * (driven_ ? std::max(kept, 0.5 * free_mass_ * speed * speed) : kept);
}

}  // namespace weft::physics
