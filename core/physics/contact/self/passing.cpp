// Self-contact (self_contact.h): nothing passes through. What impulses have left so that a vertex may
// pass through a triangle, or an edge through an edge, in the interval moves as one: all their particles
// get the mean displacement of their mass, and so do others that it brings near. Momentum is kept,
// energy is lost. (Rigid impact zones: Provot 1997; Bridson, Fedkiw, Anderson 2002; without their
// rotation, since zones are small.)
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "physics/contact/self/held.h"
#include "physics/contact/self/self_contact.h"

namespace weft::physics {
namespace {

constexpr int kRounds = 12;
// Nearer than that two may pass through each other [of the distance held].
constexpr float kNear = 2 * kLeastApart;
// Of the distance held: where nothing is changed by more, neither pairs that contact has found to be farther apart
// than it, nor those that sleep, may pass: d > r + 1.2 m (square_ways.h), and passing takes m + 2 c > 0.9 d.
constexpr float kMostChange = 0.45f;
static_assert(2 * kMostChange < 1 - kNear && 2 * kMostChange < 0.9f * kReach);

}  // namespace

std::int32_t SelfContact::zone_of(std::int32_t body) {
  while (zone_[std::size_t(body)] != body) {
    std::int32_t& up = zone_[std::size_t(body)];
    up = zone_[std::size_t(up)];
    body = up;
  }
  return body;
}

// Joins what may pass; returns whether anything may.
bool SelfContact::join_zones(std::vector<std::int32_t>& members) {
  bool any = false;
  for (const auto& piece : measured_)
    for (const SurfaceContact& c : piece.found()) {
      any = true;
      for (const std::int32_t body : c.body) {
        surfaces_->touch(body, moved_[std::size_t(body)].u[3]);
        const std::int32_t a = zone_of(c.body[0]), b = zone_of(body);
        zone_[std::size_t(std::max(a, b))] = std::min(a, b);
        members.push_back(body);
      }
    }
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  return any;
}

// Every zone's members get its mean displacement: that of what is pinned, where anything is.
void SelfContact::move_zones(const std::vector<std::int32_t>& members) {
  struct Sum {
    double moved[3] = {}, mass = 0;
    bool pinned = false;
  };
  std::map<std::int32_t, Sum> zones;
  for (const std::int32_t body : members) {
    const Displacement& u = moved_[std::size_t(body)];
    Sum& sum = zones[zone_of(body)];
    const bool pinned = !(u.u[3] > 0);
    if (pinned && !sum.pinned) sum = Sum{{}, 0, true};
    if (sum.pinned && !pinned) continue;
    const double mass = pinned ? 1 : 1 / double(u.u[3]);
    sum.mass += mass;
    for (int k = 0; k < 3; ++k) sum.moved[k] += mass * double(u.u[k]);
  }
  for (const std::int32_t body : members) {
    Displacement& u = moved_[std::size_t(body)];
    if (!(u.u[3] > 0)) continue;
    const Sum& sum = zones[zone_of(body)];
    double cut = 0;
    for (int k = 0; k < 3; ++k) {
      const float to = float(sum.moved[k] / sum.mass), by = to - u.u[k];
      surfaces_->change(body).u[k] += by;
      u.u[k] = to;
      cut += double(by) * double(by);
    }
    record_.greatest_held = std::max(record_.greatest_held, std::sqrt(cut));
  }
}

// What may pass in the interval: of what was found for contacts, unless those have moved things so far that
// others may have come near.
const SquarePairs& SelfContact::near_passing(Threads& threads) {
  const float held = kHeld * thickness_, most = kMostChange * held;
  float farthest = 0;
  for (const std::int32_t body : surfaces_->touched()) {
    const Displacement &change = surfaces_->change(body), &lift = surfaces_->lift(body);
    float square = 0;
    for (int k = 0; k < 3; ++k) {
      const float by = change.u[k] + lift.u[k];
      square += by * by;
    }
    farthest = std::max(farthest, square);
  }
  return farthest < most * most
             ? near_->still_within(kNear * held, place_.data(), moved_.data(), threads)
             : near_->all_within(kNear * held, place_.data(), moved_.data(), threads);
}

// (From here on `moved_` is what bodies do move, not what they would.)
void SelfContact::hold_together(Threads& threads) {
  for (const std::int32_t body : surfaces_->touched()) {
    Displacement& u = moved_[std::size_t(body)];
    if (!(u.u[3] > 0)) continue;
    for (int k = 0; k < 3; ++k) u.u[k] += surfaces_->change(body).u[k] + surfaces_->lift(body).u[k];
  }
  std::vector<std::int32_t> members;
  for (int round = 0;; ++round) {
    measure_surfaces(near_passing(threads), SurfaceSearch::passing, 1, threads);
    if (!join_zones(members)) break;
    if (round == kRounds) {
      forced_ = true;
      break;
    }
    move_zones(members);
  }
  record_.held += std::int64_t(members.size());
  for (const std::int32_t body : members) zone_[std::size_t(body)] = body;
}

}  // namespace weft::physics
