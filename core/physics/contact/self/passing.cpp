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
// Of the distance held: where nothing is changed by more, pairs do not pass that contact knows to stay farther apart
// than its reach.
constexpr float kMostChange = 0.45f;
static_assert(2 * kMostChange < kReach - kNear);

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

// Marks what contacts have moved so far that others may have come near than were found for contacts. Returns whether
// anything is.
bool SelfContact::mark_strayed(float most) {
  bool any = false;
  for (const std::int32_t body : surfaces_->touched()) {
    const Displacement &change = surfaces_->change(body), &lift = surfaces_->lift(body);
    float square = 0;
    for (int k = 0; k < 3; ++k) {
      const float by = change.u[k] + lift.u[k];
      square += by * by;
    }
    const bool far = square >= most * most;
    strayed_[std::size_t(body)] = far;
    any |= far;
  }
  return any;
}

// Of all pairs those that may pass now: of what was found for contacts, and of what has strayed from there. Then of
// what zones have moved, until nothing may. (From here on `moved_` is what bodies do move, not what they would.)
void SelfContact::hold_together(Threads& threads) {
  for (const std::int32_t body : surfaces_->touched()) {
    Displacement& u = moved_[std::size_t(body)];
    if (!(u.u[3] > 0)) continue;
    for (int k = 0; k < 3; ++k) u.u[k] += surfaces_->change(body).u[k] + surfaces_->lift(body).u[k];
  }
  const float held = kHeld * thickness_, near = kNear * held, most = kMostChange * held;
  std::vector<std::int32_t> members;
  const auto join = [&](const SquarePairs& pairs) {
    measure_surfaces(pairs, SurfaceSearch::passing, 1, threads);
    return join_zones(members);
  };
  bool strayed = mark_strayed(most);
  bool passing = join(near_->still_within(near, place_.data(), moved_.data(), threads));
  for (int round = 0;; ++round) {
    if (strayed)
      passing |=
          join(near_->strayed_within(near, most, strayed_, place_.data(), moved_.data(), threads));
    if (!passing) break;
    if (round == kRounds) {
      forced_ = true;
      break;
    }
    move_zones(members);
    std::fill(strayed_.begin(), strayed_.end(), std::uint8_t(0));
    for (const std::int32_t body : members) strayed_[std::size_t(body)] = 1;
    strayed = true;
    passing = false;
  }
  record_.held += std::int64_t(members.size());
  for (const std::int32_t body : members) zone_[std::size_t(body)] = body;
  if (strayed) std::fill(strayed_.begin(), strayed_.end(), std::uint8_t(0));
}

}  // namespace weft::physics
