// What bodies answer (body_answer.h).
#include "physics/contact/self/body_answer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/contact/colliders/shapes.h"
#include "physics/contact/friction.h"
#include "physics/contact/self/contact_solver.h"
#include "physics/step/keeper.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

constexpr std::size_t kAtOnce = 512;  // particles that a thread looks at in one go

float dot3(const float (&a)[3], const float (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

BodyAnswer::BodyAnswer(const Scene& scene, double reach) : scene_(scene), reach_(reach) {
  for (std::size_t c = 0; c < scene.colliders.size(); ++c)
    if (!scene.colliders[c].cuts) colliders_.push_back(c);
}

bool BodyAnswer::is_near(const Body& body, const Place& now, const Displacement& moved,
                         const ContactInterval& interval, Near& near) const {
  const double seconds = interval.seconds();
  const Collider& c = *body.collider;
  const Vec3 at{now.x[0], now.x[1], now.x[2]}, way{moved.u[0], moved.u[1], moved.u[2]};
  const Nearest nearest = nearest_at(c.shape, interval.time, body.placement.seen(at));
  if (!(nearest.distance - c.offset < reach_)) return false;
  const Vec3 carried =
      body.motion.carried(minus(at, body.placement.place), times(way, 1 / seconds), seconds);
  const Vec3 slid = minus(way, times(carried, seconds));
  const Vec3 out = body.placement.out_of(nearest.normal);
  near.gap = float(nearest.distance - c.offset);
  for (std::size_t k = 0; k < 3; ++k) near.normal[k] = float(out[k]), near.slid[k] = float(slid[k]);
  // The course has its own rule for what slides, which knows no pressing. How the surface of an animation moves by
  // itself is not known here.
  const bool rubs = c.friction.model == FrictionModel::coulomb && c.animation.empty();
  near.statik = float(rubs ? c.friction.statik : 0);
  near.dynamic = float(rubs ? c.friction.dynamic : 0);
  return true;
}

void BodyAnswer::place_bodies(const ContactInterval& interval) {
  bodies_.clear();
  for (const std::size_t c : colliders_) {
    const Collider& collider = scene_.colliders[c];
    bodies_.push_back({&collider, Placement(collider, interval.time),
                       RigidMotion(collider, interval.time, interval.seconds())});
  }
}

void BodyAnswer::find(std::span<const std::int32_t> particles, const Place* now,
                      const Displacement* moved, const ContactInterval& interval,
                      Threads& threads) {
  place_bodies(interval);
  const std::size_t parts = (particles.size() + kAtOnce - 1) / kAtOnce;
  if (found_.size() < parts) found_.resize(parts);
  threads.share(parts, parts == 1, [&](std::size_t part) {
    std::vector<Near>& found = found_[part];
    found.clear();
    const std::size_t first = part * kAtOnce;
    for (const std::int32_t n :
         particles.subspan(first, std::min(kAtOnce, particles.size() - first)))
      for (std::size_t b = 0; b < bodies_.size() && moved[n].u[3] > 0; ++b) {
        Near near{n, std::int32_t(b), 0, {}, {}, 0, 0, 0, {}};
        if (is_near(bodies_[b], now[n], moved[n], interval, near)) found.push_back(near);
      }
  });
  std::swap(near_, before_);
  near_.clear();
  const float ratio = float(interval.seconds() / seconds_), scale = ratio * ratio;
  seconds_ = interval.seconds();
  auto old = before_.begin();
  const auto place = [](const Near& n) { return std::pair(n.particle, n.body); };
  for (std::size_t part = 0; part < parts; ++part)
    for (Near& near : found_[part]) {
      while (old != before_.end() && place(*old) < place(near)) ++old;
      if (old != before_.end() && place(*old) == place(near)) {
        near.pressed = old->pressed * scale;
        for (int k = 0; k < 3; ++k) near.rubbed[k] = old->rubbed[k] * scale;
      }
      near_.push_back(near);
    }
}

void BodyAnswer::begin(Displacement* change) const {
  for (const Near& l : near_)
    for (int k = 0; k < 3; ++k) change[l.particle].u[k] += l.pressed * l.normal[k] + l.rubbed[k];
}

float BodyAnswer::sweep(Displacement* change) {
  float greatest = 0;
  for (Near& l : near_) {
    float* const u = change[l.particle].u;
    const float left = l.gap + u[0] * l.normal[0] + u[1] * l.normal[1] + u[2] * l.normal[2];
    if (left >= 0 && l.pressed == 0) continue;  // and so rubs nothing
    float way[3], wanted[3];
    for (int k = 0; k < 3; ++k) way[k] = l.slid[k] + u[k];
    const float out = dot3(way, l.normal);
    const float pressed = std::max(0.0f, l.pressed - left);
    for (int k = 0; k < 3; ++k) wanted[k] = l.rubbed[k] - (way[k] - out * l.normal[k]);
    const float slide = std::sqrt(dot3(wanted, wanted));
    const auto share = float(taken_by_friction(l.statik, l.dynamic, slide, pressed));
    for (int k = 0; k < 3; ++k) {
      const float rubbed = wanted[k] * share;
      const float by = (pressed - l.pressed) * l.normal[k] + (rubbed - l.rubbed[k]);
      l.rubbed[k] = rubbed;
      u[k] += by;
      greatest = std::max(greatest, std::abs(by));
    }
    l.pressed = pressed;
  }
  return greatest;
}

void BodyAnswer::keep_out(Displacement* lift) const {
  for (const Near& l : near_) {
    float* const u = lift[l.particle].u;
    const float into = std::min(0.0f, u[0] * l.normal[0] + u[1] * l.normal[1] + u[2] * l.normal[2]);
    for (int k = 0; k < 3; ++k) u[k] -= into * l.normal[k];
  }
}

void BodyAnswer::keep(Keeper& keeper) {
  keeper(near_);
  keeper(seconds_);
}

std::size_t BodyAnswer::bytes() const {
  std::size_t all = near_.capacity() + before_.capacity();
  for (const std::vector<Near>& found : found_) all += found.capacity();
  return all * sizeof(Near);
}

}  // namespace weft::physics
