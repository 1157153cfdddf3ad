// Solves contacts (contact_solver.h).
#include "physics/contact/self/contact_solver.h"

#include <algorithm>
#include <bit>

#include "physics/step/keeper.h"

namespace weft::physics {
namespace {

constexpr int kSweeps = 10, kSeparatingSweeps = 4;
// Of the first sweep's greatest correction, and of the distance held: less is enough.
constexpr float kEnough = 0.02f, kEnoughOfHeld = 1e-5f;
// Of what is missing of a distance, that is put right in one run; nothing where less is missing than so
// much of it.
constexpr float kShare = 0.3f, kShallow = 0.002f;
// Thicknesses a second: positions alone move no faster. Faster, they would stretch what does not move along,
// and that makes energy.
constexpr float kSlow = 2;
// Times its weight, that presses a sheet on another: positions alone undo what that moves it by.
constexpr double kPressed = 4;
constexpr std::int32_t kPacketsAtOnce = 8, kFewPackets = 64;

}  // namespace

template <int N>
ContactSolver<N>::ContactSolver(std::size_t bodies, BodyAnswer& answer,
                                const ContactKernels<N>& kernels)
    : answer_(answer),
      kernels_(kernels),
      bodies_(bodies),
      colours_(bodies),
      is_touched_(bodies + kPacket),
      change_(bodies + kPacket),
      lift_(bodies + kPacket) {}

template <int N>
void ContactSolver<N>::touch(std::int32_t body, float inverse_mass) {
  const auto n = std::size_t(body);
  if (is_touched_[n]) return;
  is_touched_[n] = 1;
  touched_.push_back(body);
  change_[n] = lift_[n] = {{0, 0, 0, inverse_mass}};
}

template <int N>
void ContactSolver<N>::clear() {
  for (const std::int32_t body : touched_) is_touched_[std::size_t(body)] = 0;
  touched_.clear();
  contacts_.clear();
}

// A pinned body is never written to anything new, so that any number of contacts may have it at once.
template <int N>
void ContactSolver<N>::colour() {
  colour_.resize(contacts_.size());
  begin_.assign(kColours + 2, 0);
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    std::uint64_t taken = 0;
    for (const std::int32_t body : contacts_[k].body) {
      touch(body, moved_[body].u[3]);
      taken |= colours_[std::size_t(body)];
    }
    const int colour = std::countr_one(taken);
    colour_[k] = std::uint8_t(colour);
    ++begin_[std::size_t(colour) + 1];
    if (colour == kColours) continue;
    for (const std::int32_t body : contacts_[k].body)
      colours_[std::size_t(body)] |= std::uint64_t(1) << colour;
  }
  for (const std::int32_t body : touched_) colours_[std::size_t(body)] = 0;
  // In order, so that what is done with them goes through memory once.
  touched_.clear();
  for (std::size_t n = 0; n < bodies_; n += kPacket) {
    if (std::none_of(&is_touched_[n], &is_touched_[n] + kPacket, [](auto t) { return t != 0; }))
      continue;
    for (std::size_t body = n; body < n + kPacket; ++body)
      if (is_touched_[body]) touched_.push_back(std::int32_t(body));
  }
}

template <int N>
void ContactSolver<N>::put(const Contact<N>& c, std::int32_t at) {
  Packet& p = packets_[std::size_t(at / kPacket)];
  const int lane = at % kPacket;
  for (std::size_t n = 0; n < N; ++n) {
    p.body[n][lane] = c.body[n];
    p.share[n][lane] = c.share[n];
  }
  for (std::size_t k = 0; k < 3; ++k) p.normal[k][lane] = c.normal[k];
  p.distance[lane] = c.distance;
  p.held[lane] = c.held;
  p.friction[lane] = c.friction;
}

template <int N>
void ContactSolver<N>::begin_with(std::size_t contact, const Impulse& impulse, float scale) {
  const std::int32_t at = place_[contact];
  Packet& p = packets_[std::size_t(at / kPacket)];
  p.pressed[at % kPacket] = impulse.pressed * scale;
  for (int k = 0; k < 3; ++k) p.rubbed[k][at % kPacket] = impulse.rubbed[k] * scale;
}

// The packets of every colour, in order of the contacts.
template <int N>
void ContactSolver<N>::fill(double seconds) {
  std::int32_t next[kColours + 1], packets = 0;
  for (std::size_t c = 0; c <= kColours; ++c) {
    const std::int32_t count = begin_[c + 1];
    begin_[c] = packets;
    next[c] = packets * kPacket;
    packets += c == kColours ? count : (count + kPacket - 1) / kPacket;
  }
  begin_[kColours + 1] = packets;
  Packet none{};
  for (int n = 0; n < N; ++n)
    for (int lane = 0; lane < kPacket; ++lane) none.body[n][lane] = std::int32_t(bodies_) + lane;
  packets_.assign(std::size_t(packets), none);
  place_.resize(contacts_.size());
  held_ = 0;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    std::int32_t& at = next[colour_[k]];
    place_[k] = at;
    put(contacts_[k], at);
    held_ = std::max(held_, contacts_[k].held);
    at += colour_[k] == kColours ? kPacket : 1;
  }
  // Both are in order of their keys.
  const float ratio = float(seconds / seconds_), scale = ratio * ratio;
  auto old = impulses_.begin();
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    while (old != impulses_.end() && old->key < contacts_[k].key) ++old;
    if (old != impulses_.end() && old->key == contacts_[k].key) begin_with(k, *old, scale);
  }
  seconds_ = seconds;
}

// work(first packet, packets, thread's slot) for parts of a colour after another.
template <int N>
template <class Work>
void ContactSolver<N>::for_each_part(const Work& work) {
  const bool alone = std::int32_t(packets_.size()) < kFewPackets || threads_->count() == 1;
  for (std::size_t c = 0; c <= kColours; ++c) {
    const std::int32_t first = begin_[c], count = begin_[c + 1] - first;
    if (count == 0) continue;
    if (alone || count <= kPacketsAtOnce || c == kColours) {
      work(first, count);
      continue;
    }
    threads_->share(std::size_t((count + kPacketsAtOnce - 1) / kPacketsAtOnce), false,
                    [&](std::size_t k) {
                      const std::int32_t from = first + std::int32_t(k) * kPacketsAtOnce;
                      work(from, std::min(kPacketsAtOnce, first + count - from));
                    });
  }
}

template <int N>
float ContactSolver<N>::sweep(Displacement* change, float enough, int most) {
  std::vector<float>& corrections = corrections_;
  corrections.assign(packets_.size(), 0);
  float first = 0, greatest = 0;
  for (int s = 0; s < most; ++s) {
    for_each_part([&](std::int32_t from, std::int32_t count) {
      corrections[std::size_t(from)] =
          kernels_.sweep({&packets_[std::size_t(from)], count, places_, moved_, change, 0, 0});
    });
    ++sweeps_;
    greatest = *std::max_element(corrections.begin(), corrections.end());
    if (change == change_.data())
      greatest = std::max(greatest, answer_.sweep(change));
    else
      answer_.keep_out(change);
    if (s == 0) first = greatest;
    if (greatest <= std::max(enough, kEnough * first)) break;
  }
  return greatest;
}

// Returns the greatest part of the distance held that was missing.
template <int N>
float ContactSolver<N>::separate(float most) {
  corrections_.assign(packets_.size(), 0);
  for_each_part([&](std::int32_t from, std::int32_t count) {
    corrections_[std::size_t(from)] = kernels_.separate(
        {&packets_[std::size_t(from)], count, places_, moved_, change_.data(), kShare, most});
  });
  const float deepest = *std::max_element(corrections_.begin(), corrections_.end());
  if (deepest > kShallow) sweep(lift_.data(), kEnoughOfHeld * held_, kSeparatingSweeps);
  return deepest;
}

template <int N>
void ContactSolver<N>::keep_impulses() {
  impulses_.clear();
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const Packet& p = packets_[std::size_t(place_[k] / kPacket)];
    const int lane = place_[k] % kPacket;
    if (!(p.pressed[lane] > 0)) continue;
    impulses_.push_back({contacts_[k].key,
                         p.pressed[lane],
                         {p.rubbed[0][lane], p.rubbed[1][lane], p.rubbed[2][lane]}});
  }
}

template <int N>
float ContactSolver<N>::solve(const Place* place, const Place* now, const Displacement* moved,
                              const ContactInterval& interval, Threads& threads) {
  places_ = place;
  moved_ = moved;
  threads_ = &threads;
  if (contacts_.empty()) {
    forget();
    answer_.forget();
    return 0;
  }
  const double seconds = interval.seconds();
  colour();
  fill(seconds);
  for_each_part([&](std::int32_t from, std::int32_t count) {
    kernels_.prepare({&packets_[std::size_t(from)], count, places_, moved_, change_.data(), 0, 0});
  });
  if (answer_.given()) {
    answer_.find(touched_, now, moved, interval, threads);
    answer_.begin(change_.data());
  }
  sweep(change_.data(), kEnoughOfHeld * held_, kSweeps);
  keep_impulses();
  const double most = (kSlow * double(held_) + kPressed * interval.gravity * seconds) * seconds;
  const float deepest = separate(float(most));
  settle(interval.substeps);
  return deepest;
}

// Where things met in an interval of several substeps, impulses act in the last of them: it moves positions
// by that part of the displacement.
template <int N>
void ContactSolver<N>::settle(int substeps) {
  const float beyond = 1 - 1 / float(substeps);
  if (!(beyond > 0)) return;
  for (const std::int32_t body : touched_)
    for (std::size_t k = 0; k < 3; ++k)
      lift_[std::size_t(body)].u[k] -= beyond * change_[std::size_t(body)].u[k];
}

template <int N>
void ContactSolver<N>::keep(Keeper& keeper) {
  keeper(impulses_);
  keeper(seconds_);
  keeper(sweeps_);
}

template <int N>
std::size_t ContactSolver<N>::bytes() const {
  return contacts_.capacity() * sizeof(Contact<N>) + packets_.capacity() * sizeof(Packet) +
         bodies_ * (8 + 1 + 2 * sizeof(Displacement)) + touched_.capacity() * 4 +
         impulses_.capacity() * sizeof(Impulse);
}

template class ContactSolver<2>;
template class ContactSolver<4>;

}  // namespace weft::physics
