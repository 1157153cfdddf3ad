// Self-contact (self_contact.h): the contacts of an interval, and what comes of them; pairs too near now.
#include <algorithm>
#include <cmath>

#include "physics/contact/self/held.h"
#include "physics/contact/self/self_contact.h"
#include "physics/model/projected_motion.h"
#include "physics/step/keeper.h"

namespace weft::physics {
namespace {

constexpr std::size_t kAtOnce = 256;  // pairs of squares that are measured in one go
constexpr std::size_t kFewLists = 8;  // that one thread does faster
constexpr int kFirstOfKey = 36;       // bits of a contact's key that follow its first number

bool is_none(const Displacement& d) {
  return d.u[0] == 0 && d.u[1] == 0 && d.u[2] == 0;
}

}  // namespace

float SelfContact::friction_of(std::int32_t a, std::int32_t b) const {
  return 0.5f * (friction_[std::size_t(a)] + friction_[std::size_t(b)]);
}

// By what is first in their keys, the number of a body or square, then by all of them.
template <int N>
void SelfContact::sort(std::vector<Contact<N>>& contacts, std::vector<Contact<N>>& to) {
  const auto first = [](const Contact<N>& c) { return std::size_t(c.key >> kFirstOfKey); };
  std::fill(begin_.begin(), begin_.end(), 0);
  for (const Contact<N>& c : contacts) ++begin_[first(c) + 1];
  for (std::size_t n = 1; n < begin_.size(); ++n) begin_[n] += begin_[n - 1];
  to.resize(contacts.size());
  for (const Contact<N>& c : contacts) to[std::size_t(begin_[first(c)]++)] = c;
  for (std::size_t i = 0; i < to.size();) {
    std::size_t end = i + 1;
    while (end < to.size() && first(to[end]) == first(to[i])) ++end;
    std::sort(to.begin() + std::ptrdiff_t(i), to.begin() + std::ptrdiff_t(end),
              [](const Contact<N>& a, const Contact<N>& b) { return a.key < b.key; });
    i = end;
  }
  std::swap(contacts, to);
}

// Pairs of the list that touch in the interval, and of those beside each other.
void SelfContact::find_among_particles(Threads& threads) {
  const std::size_t chunks = search_.chunks(), blocks = blocks_.all().size();
  if (meeting_.size() < chunks + blocks) meeting_.resize(chunks + blocks);
  const auto meet = [&](const PairSearch::Pairs& pairs, PairList& meeting) {
    meeting.count = 0;
    if (pairs.count == 0) return;
    meeting.count =
        kernels_.sheets.meeting_pairs({place_.data(), moved_.data(), int(pairs.count), pairs.owner,
                                       pairs.neighbour, kReach, meeting.room(pairs.count)});
  };
  threads.share(chunks + blocks, chunks + blocks < kFewLists, [&](std::size_t k) {
    if (k < chunks) return meet(search_.pairs(k), meeting_[k]);
    const std::size_t b = k - chunks;
    meeting_[k].count = 0;
    if (!blocks_.all()[b].active) return;
    // They end the interval as near, or begin it.
    list_beside(b, kReach * held(sheets_[std::size_t(blocks_.all()[b].sheet)]));
    const PairList& beside = beside_[b];
    meet({beside.owner.data(), beside.neighbour.data(), std::size_t(beside.count)}, meeting_[k]);
  });
  std::vector<Contact<2>>& contacts = spheres_->contacts();
  for (std::size_t k = 0; k < chunks + blocks; ++k)
    for (std::size_t i = 0; i < std::size_t(meeting_[k].count); ++i) {
      const auto [a, b] = std::minmax(meeting_[k].owner[i], meeting_[k].neighbour[i]);
      if (course_ && by_course(a, b)) continue;
      Contact<2> c{};
      c.key = std::uint64_t(a) << kFirstOfKey | std::uint64_t(b);
      c.body = {a, b};
      c.held = place_[std::size_t(a)].x[3] + place_[std::size_t(b)].x[3];
      c.friction = friction_of(a, b);
      contacts.push_back(c);
    }
  sort(contacts, unsorted_spheres_);
}

// Of what squares of meshes have in common, one owns each vertex and edge. `first`: of the piece's pairs.
void SelfContact::keep_owned(const SquarePairs& pairs, std::size_t first, Measured& found) const {
  const std::vector<std::uint8_t>& owned = near_->owned();
  const auto end = found.room.begin() + std::ptrdiff_t(found.count);
  const auto kept = std::remove_if(found.room.begin(), end, [&](const SurfaceContact& c) {
    const std::size_t pair = first + std::size_t(c.pair);
    return !owns(c, owned[std::size_t(pairs.owner[pair])],
                 owned[std::size_t(pairs.neighbour[pair])]);
  });
  found.count = std::size_t(kept - found.room.begin());
}

// Of all pairs, piece by piece.
void SelfContact::measure_surfaces(const SquarePairs& pairs, SurfaceSearch search, float reach,
                                   Threads& threads) {
  pairs_ = &pairs;
  const std::size_t pieces = (pairs.count + kAtOnce - 1) / kAtOnce;
  if (measured_.size() < pieces) measured_.resize(pieces);
  for (std::size_t k = pieces; k < measured_.size(); ++k) measured_[k].count = 0;
  threads.share(pieces, pieces < kFewLists, [&](std::size_t k) {
    const std::size_t first = k * kAtOnce, count = std::min(pairs.count - first, kAtOnce);
    Measured& found = measured_[k];
    if (found.room.size() < count * kKindsOfPair) found.room.resize(count * kKindsOfPair);
    found.count = std::size_t(kernels_.sheets.surface_pairs(
        {place_.data(), moved_.data(), rest_.data(), near_->squares().data(), int(count),
         pairs.owner.data() + first, pairs.neighbour.data() + first, search, reach, kLeastApart,
         found.room.data()}));
    if (!near_->owned().empty()) keep_owned(pairs, first, found);
    std::sort(found.room.begin(), found.room.begin() + std::ptrdiff_t(found.count),
              [](const SurfaceContact& a, const SurfaceContact& b) {
                return a.pair != b.pair ? a.pair < b.pair : a.kind < b.kind;
              });
  });
}

void SelfContact::find_among_surfaces(Threads& threads) {
  measure_surfaces(
      near_->within(kReach * kHeld * thickness_, place_.data(), moved_.data(), threads),
      SurfaceSearch::contacts, kReach, threads);
  std::vector<Contact<4>>& contacts = surfaces_->contacts();
  for (std::size_t k = 0; k < measured_.size(); ++k)
    for (const SurfaceContact& found : measured_[k].found()) {
      const std::size_t pair = k * kAtOnce + std::size_t(found.pair);
      Contact<4> c;
      c.key = std::uint64_t(pairs_->owner[pair]) << kFirstOfKey |
              std::uint64_t(pairs_->neighbour[pair]) << 4 | std::uint64_t(found.kind);
      std::copy_n(found.body, 4, c.body.begin());
      std::copy_n(found.share, 4, c.share.begin());
      std::copy_n(found.normal, 3, c.normal.begin());
      c.distance = found.distance;
      c.held = found.held;
      c.friction = friction_of(found.body[0], found.body[3]);
      contacts.push_back(c);
    }
  sort(contacts, unsorted_surfaces_);
}

// Velocities change with displacements; positions also by what is put apart. Contacts that nothing presses change
// nothing.
template <int N>
void SelfContact::scatter(ContactSolver<N>& solver, const ContactInterval& interval) {
  const double dt = interval.dt;
  const float inverse = float(1 / interval.seconds());
  touched_ = !solver.touched().empty();
  moving_.clear();
  for (const Sheet& s : sheets_) moving_.push_back({&s.model->particles(), s.model->history()});
  double taken = 0;
  for (const std::int32_t n : solver.touched()) {
    const Displacement &change = solver.change(n), &lift = solver.lift(n);
    const float w = change.u[3];
    if (!(w > 0) || (is_none(change) && is_none(lift))) continue;
    const Site s = site(n);
    const auto [row, column] = sheets_[s.cloth].place(s.row, s.column);
    Particles& l = *moving_[s.cloth].particles;
    History* const history = moving_[s.cloth].history;
    const bool goes_on = history && history->goes_on(l, row, column);
    double before = 0, after = 0;
    float way = 0;
    for (int k = 0; k < 3; ++k) {
      float& x = l.x.at(k, row, column);
      float& v = l.v.at(k, row, column);
      const float dv = change.u[k] * inverse, dx = change.u[k] + lift.u[k];
      before += double(v) * v;
      v += dv;
      after += double(v) * v;
      const float was = x;
      x += dx;
      now_[std::size_t(n)].x[k] = x;
      way += (x - was) * (x - was);
      if (goes_on) history->shift(l, k, row, column, dx - dv * float(dt), dv);
    }
    if (N == 4) near_->shift(n, std::sqrt(way));
    taken += (before - after) / (2 * double(w));
  }
  record_.energy_taken += taken;
}

template <int N>
void SelfContact::solve(ContactSolver<N>& solver, const ContactInterval& interval,
                        Threads& threads) {
  record_.contacts_now = std::int64_t(solver.contacts().size());
  record_.contacts += record_.contacts_now;
  const std::int64_t swept = solver.sweeps();
  const double missing = solver.solve(place_.data(), now_.data(), moved_.data(), interval, threads);
  record_.least_distance = std::min(record_.least_distance, 1 - missing);
  record_.missing_now = missing;
  record_.sweeps += solver.sweeps() - swept;
}

void SelfContact::respond(const ContactInterval& interval, Threads& threads) {
  touched_ = false;
  record_.contacts_now = 0;
  record_.missing_now = 0;
  if (blocks_.active() == 0) {
    if (near_) near_->wake();
    return;
  }
  if (surfaces()) {
    find_among_surfaces(threads);
    solve(*surfaces_, interval, threads);
    hold_together(threads);
    scatter(*surfaces_, interval);
    surfaces_->clear();
  } else {
    find_among_particles(threads);
    solve(*spheres_, interval, threads);
    scatter(*spheres_, interval);
    spheres_->clear();
    if (course_)
      record_.contacts_now += std::int64_t(push_by_course(interval.dt, interval.substeps));
  }
}

// The run goes on as if nobody had asked.
SelfContact::Overlaps SelfContact::overlaps() {
  Keeper before;
  keep(before, true);
  const Overlaps found = find_overlaps();
  restart();
  const std::vector<std::byte> kept = before.take();
  Keeper back(kept);
  keep(back, true);
  return found;
}

SelfContact::Overlaps SelfContact::find_overlaps() {
  Threads one(1);
  Overlaps found;
  const auto add = [&](double missing) {
    if (missing <= 0) return;
    ++found.pairs;
    found.deepest = std::max(found.deepest, missing);
  };
  if (surfaces()) {
    begin(one);
    gather(one);
    near_->list(now_.data(), one);
    measure_surfaces(near_->within(thickness_, place_.data(), moved_.data(), one),
                     SurfaceSearch::contacts, 1, one);
    for (const auto& piece : measured_)
      for (const SurfaceContact& c : piece.found())
        add(double(c.held) / kHeld - double(c.distance));
    return found;
  }
  search(0, one);
  for_each_pair([&](const Site& p, const Site& q) {
    const Sheet &sheet = sheets_[p.cloth], &other = sheets_[q.cloth];
    if (only_neighbours(p, q)) return;
    double square = 0;
    for (int i = 0; i < 3; ++i) {
      const double d =
          double(sheet.points->x.at(i, p.row, p.column)) - other.points->x.at(i, q.row, q.column);
      square += d * d;
    }
    add(0.5 * (double(sheet.thickness) + other.thickness) - std::sqrt(square));
  });
  return found;
}

}  // namespace weft::physics
