// Contacts between bodies: impulses on displacements (contact.h; contact/self/self_contact.h has the rule).
//
// With u the displacements in an interval, r = Σ b_i u_i the relative displacement of two surfaces, n the
// normal and d the distance at the interval's start, a contact asks that
//
//   n·r >= min(d, h) - d        things approach until they are h apart, and no further when nearer
//   |r_t| = 0, or as little as impulses along the surface of μ times the normal one allow (Coulomb)
//
// Impulses are accumulated, the normal one is never negative, and every body i gets b_i w_i of each
// (sequential impulses: Catto 2005; Guendelman, Bridson, Fedkiw 2003). The contacts of a packet share no
// body, so that all of its lanes go at once.
#include "physics/kernels/contact.h"
#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::BodyBlock;
using physics::ContactPacket;
using physics::ContactPackets;
using physics::Displacement;
using physics::kPacket;
using physics::MeetingPairs;
using physics::Place;
using physics::StrayedBodies;

constexpr float kTiny = 1e-12f;
constexpr int kRecord = 4;  // floats of a place, and of a displacement

WEFT_INLINE Wide3 load_each(const float (&of)[3][kPacket], int l) {
  return {load(of[0] + l), load(of[1] + l), load(of[2] + l)};
}
WEFT_INLINE void store_each(float (&to)[3][kPacket], int l, Wide3 v) {
  store(to[0] + l, v.x), store(to[1] + l, v.y), store(to[2] + l, v.z);
}

// The shares of two bodies are 1 and -1.
template <int N>
WEFT_INLINE Wide3 relative(const ContactPacket<N>& p, const Wide4 (&body)[N], int l) {
  if constexpr (N == 2) return body[0].xyz - body[1].xyz;
  Wide3 sum = body[0].xyz * load(p.share[0] + l);
  for (int n = 1; n < N; ++n) sum = sum + body[n].xyz * load(p.share[n] + l);
  return sum;
}

template <int N>
WEFT_INLINE void read(const ContactPacket<N>& p, const float* records, int l, Wide4 (&body)[N]) {
  for (int n = 0; n < N; ++n) body[n] = records_at(records, kRecord, p.body[n] + l);
}

template <int N>
WEFT_INLINE void put(const ContactPacket<N>& p, int l, int n, const Wide4& record,
                     Displacement* change) {
#if WEFT_LANES >= 4
  Wide r[4] = {record.xyz.x, record.xyz.y, record.xyz.z, record.last};
  turn(r);
  for (int k = 0; k < 4; ++k)
    for_each_quarter(r[k], [&](int quarter, Four one) {
      store_four(change[p.body[n][l + quarter + k]].u, one);
    });
#else
  store_four(change[p.body[n][l]].u,
             Four{record.xyz.x[0], record.xyz.y[0], record.xyz.z[0], record.last[0]});
#endif
}

// Every body gets its part of an impulse.
template <int N>
WEFT_INLINE void give(const ContactPacket<N>& p, int l, Wide3 impulse, Wide4 (&body)[N],
                      Displacement* change) {
  for (int n = 0; n < N; ++n) {
    const Wide share = N == 2 ? wide(n == 0 ? 1.0f : -1.0f) : load(p.share[n] + l);
    body[n].xyz = body[n].xyz + impulse * (share * body[n].last);
    put(p, l, n, body[n], change);
  }
}

// Two bodies: the normal and the distance, from their places. In one place: apart along y.
WEFT_INLINE void measure_two(ContactPacket<2>& p, const ContactPackets<2>& given, int l) {
  const Wide4 d = differences_at(given.place->x, kRecord, p.body[0] + l, p.body[1] + l);
  const Wide square = dot(d.xyz, d.xyz);
  const WideInt together = square < kTiny * kTiny;
  const Wide distance = select(together, wide(kTiny), sqrt(square));
  const Wide3 off = select(together, {Wide{}, wide(kTiny), Wide{}}, d.xyz);
  store_each(p.normal, l, off * (1.0f / distance));
  store(p.distance + l, distance);
  store(p.held + l, d.last);
}

template <int N>
WEFT_INLINE void prepare_lanes(ContactPacket<N>& p, const ContactPackets<N>& given, int l) {
  if constexpr (N == 2) measure_two(p, given, l);
  const Wide3 normal = load_each(p.normal, l);
  Wide4 moved[N], change[N];
  read(p, given.moved->u, l, moved);
  read(p, given.change->u, l, change);
  Wide mass{};
  for (int n = 0; n < N; ++n) {
    const Wide share = N == 2 ? wide(1) : load(p.share[n] + l);
    mass = mass + share * share * change[n].last;
  }
  const Wide3 r = relative(p, moved, l);
  const Wide along = dot(normal, r), distance = load(p.distance + l);
  store_each(p.slide, l, r - normal * along);
  store(p.gap + l, along + (distance - min(distance, load(p.held + l))));
  store(p.per + l, select(mass > 0.0f, 1.0f / mass, Wide{}));
  // What the interval before needed is a good beginning.
  const Wide pressed = load(p.pressed + l);
  if (any(pressed > 0.0f))
    give(p, l, normal * pressed + load_each(p.rubbed, l), change, given.change);
}

template <int N>
WEFT_INLINE Wide sweep_lanes(ContactPacket<N>& p, Displacement* changes, int l) {
  Wide4 change[N];
  read(p, changes->u, l, change);
  const Wide3 normal = load_each(p.normal, l), r = relative(p, change, l);
  const Wide along = dot(normal, r), per = load(p.per + l), before = load(p.pressed + l);
  const Wide pressed = max(Wide{}, before - (along + load(p.gap + l)) * per);
  const Wide more = pressed - before;
  Wide3 impulse = normal * more;
  const Wide friction = load(p.friction + l);
  Wide greatest = abs(more);
  if (any((friction > 0.0f) & ((pressed > 0.0f) | (before > 0.0f)))) {
    const Wide3 rubbed = load_each(p.rubbed, l);
    const Wide3 slide = load_each(p.slide, l) + (r - normal * along);
    const Wide3 asked = rubbed - slide * per;
    const Wide size = sqrt(dot(asked, asked)), most = friction * pressed;
    const Wide3 given = asked * select(size >= most, most / max(size, wide(1e-30f)), wide(1));
    const Wide3 rub = given - rubbed;
    impulse = impulse + rub;
    store_each(p.rubbed, l, given);
    // (Its length may be 0 where it is not.)
    greatest = max(greatest, max(abs(rub.x), max(abs(rub.y), abs(rub.z))));
  }
  if (!any(greatest > 0.0f)) return Wide{};
  store(p.pressed + l, pressed);
  give(p, l, impulse, change, changes);
  return select(per > 0.0f, greatest / max(per, wide(1e-30f)), Wide{});
}

// What is left too close is put apart, in positions alone: `gap` is then the share of what is missing, or
// what is there to spare, and there is no friction.
template <int N>
WEFT_INLINE Wide separate_lanes(ContactPacket<N>& p, const ContactPackets<N>& given, int l) {
  Wide4 change[N];
  read(p, given.change->u, l, change);
  const Wide held = load(p.held + l), distance = load(p.distance + l);
  const Wide left = dot(load_each(p.normal, l), relative(p, change, l)) + load(p.gap + l) +
                    (min(distance, held) - held);
  store(p.gap + l, select(left < 0.0f, max(left * given.share, wide(-given.most)), left));
  for (int k = 0; k < 3; ++k) store(p.rubbed[k] + l, Wide{});
  store(p.pressed + l, Wide{});
  store(p.friction + l, Wide{});
  return select(load(p.per + l) > 0.0f, -left / max(held, wide(kTiny)), Wide{});
}

template <int N>
void prepare(const ContactPackets<N>& given) {
  for (int k = 0; k < given.packets; ++k)
    for (int l = 0; l < kPacket; l += kLanes) prepare_lanes(given.packet[k], given, l);
}

template <int N>
float sweep(const ContactPackets<N>& given) {
  Wide most{};
  for (int k = 0; k < given.packets; ++k)
    for (int l = 0; l < kPacket; l += kLanes)
      most = max(most, sweep_lanes(given.packet[k], given.change, l));
  return greatest(most);
}

template <int N>
float separate(const ContactPackets<N>& given) {
  Wide most{};
  for (int k = 0; k < given.packets; ++k)
    for (int l = 0; l < kPacket; l += kLanes)
      most = max(most, separate_lanes(given.packet[k], given, l));
  return greatest(most);
}

}  // namespace

// Declared first, as constants are known to this file alone otherwise.
extern const physics::ContactKernels<2> kContactsOfTwo;
extern const physics::ContactKernels<4> kContactsOfFour;
const physics::ContactKernels<2> kContactsOfTwo{prepare<2>, sweep<2>, separate<2>};
const physics::ContactKernels<4> kContactsOfFour{prepare<4>, sweep<4>, separate<4>};

void gather_bodies(const BodyBlock& given) {
  const BodyBlock b = given;
  for (int j = 0; j < b.rows; ++j)
    for (int i = 0; i < b.columns; i += kLanes) {
      const std::ptrdiff_t at = j * b.stride + i, body = j * b.body_stride + i;
      const Wide3 x = load3(b.x, at);
      const Wide3 before = records_in_row(b.before[body].x, kRecord).xyz;
      put_records(b.now[body].x, kRecord, {x, wide(b.half_held)});
      put_records(b.moved[body].u, kRecord, {x - before, load(b.w + at)});
    }
}

bool any_strayed(const StrayedBodies& given) {
  const StrayedBodies b = given;
  const Wide3 before = wide3(b.before[0], b.before[1], b.before[2]);
  const Wide3 common = wide3(b.common[0], b.common[1], b.common[2]);
  for (int j = 0; j < b.rows; ++j) {
    WideInt strayed{};
    for (int i = 0; i < b.columns; i += kLanes) {
      const std::ptrdiff_t at = j * b.stride + i;
      const Wide4 from = records_in_row(b.from[at].x, kRecord);
      const Wide3 start = records_in_row(b.place[at].x, kRecord).xyz - from.xyz - before;
      const Wide3 end = start + (records_in_row(b.moved[at].u, kRecord).xyz - common);
      const Wide farthest = max(dot(start, start), dot(end, end)), most = from.last * from.last;
      strayed = strayed | (~(farthest <= most) & lanes_below(b.columns - i));
    }
    if (any(strayed)) return true;
  }
  return false;
}

int meeting_pairs(const MeetingPairs& given) {
  const MeetingPairs s = given;
  int found = 0;
  for (int k = 0; k < s.pairs; k += kLanes) {
    const Wide4 d = differences_at(s.place->x, kRecord, s.owner + k, s.neighbour + k);
    const Wide4 u = differences_at(s.moved->u, kRecord, s.owner + k, s.neighbour + k);
    const Wide square = dot(d.xyz, d.xyz), near = d.last * s.reach;
    // d + min(0, n·u) < near, times d.
    const Wide distance = sqrt(square);
    const LaneBits meet = where_less(square + min(Wide{}, dot(d.xyz, u.xyz)), near * distance) &
                          first_lanes(s.pairs - k);
    if (meet == 0) continue;
    store_lanes(s.meeting.owner + found, meet, lanes_at(s.owner + k));
    found += store_lanes(s.meeting.neighbour + found, meet, lanes_at(s.neighbour + k));
  }
  return found;
}

}  // namespace weft::WEFT_KERNELS
