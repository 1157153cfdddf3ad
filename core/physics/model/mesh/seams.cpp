#include "physics/model/mesh/seams.h"

#include <algorithm>
#include <cmath>

#include "physics/kernels/mesh_sweep.h"
#include "physics/model/projected_motion.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

using Members = std::span<const Particles::Place>;
constexpr double kOpen = 1e-4;  // m; what is nearer than that to its centre counts as closed

// The mean of what is held, or else by mass; `value(n)` and the inverse mass `w(n)` of each of `count`.
template <class Value, class InverseMass>
Vec3 centre(std::size_t count, const Value& value, const InverseMass& w) {
  Vec3 sum{};
  double weight = 0;
  bool held = false;
  for (std::size_t n = 0; n < count; ++n) {
    const double inverse = w(n);
    if (!(inverse > 0) && !held) held = true, sum = {}, weight = 0;
    if (held && inverse > 0) continue;
    const double mass = held ? 1 : 1 / inverse;
    sum = plus(sum, times(value(n), mass));
    weight += mass;
  }
  return times(sum, 1 / weight);
}

// One group in a substep.
class Group {
 public:
  // `history`: of the second order, else null.
  Group(Particles& particles, Members members, double dt, History* history)
      : particles_(particles),
        members_(members),
        dt_(dt),
        history_(history),
        x_(mean_of(particles.x)),
        v_(mean_of(particles.v)),
        before_(history ? mean_of(particles.previous) : minus(x_, times(v_, dt))) {
    for_each_free([&](std::size_t n, double mass) {
      const Vec3 e = apart(n), d = minus(at(particles_.x, n), x_);
      far_ = std::max(far_, length(e));
      ee_ += mass * dot(e, e), de_ += mass * dot(d, e), dd_ += mass * dot(d, d);
    });
  }

  bool within_reach() const { return far_ <= kSewingSpeed * dt_; }

  void join() {
    if (!history_) {
      set(particles_.x, x_);
      set(particles_.v, v_);
      return;
    }
    bool go_on = true;
    for_each_free([&](std::size_t n, double) {
      go_on = go_on && history_->goes_on(particles_, members_[n].j, members_[n].i);
    });
    if (history_->left.kept) {
      set(particles_.x, history_->left.x);
      set(particles_.v, history_->left.v);
    } else {
      set(particles_.x, x_);
      set(particles_.v, v_);
    }
    for (Rows* past : {&particles_.previous, &history_->v_before}) set(*past, mean_of(*past));
    set(history_->v_end, mean_of(go_on ? particles_.v : history_->v_end));
  }

  // With e and d the way to each from the centre, before the substep and now: the sum of m d² is to be what the
  // members' way leaves of that of m e². False where they cannot be drawn.
  bool draw() {
    const double share = 1 - kSewingSpeed * dt_ / far_;
    if (dd_ <= share * share * ee_) return true;
    return history_ ? draw_smoothly(share) : draw_by_impulse(share);
  }

 private:
  // So much of e is taken from d.
  bool draw_by_impulse(double share) {
    const double root = de_ * de_ - ee_ * (dd_ - share * share * ee_);
    if (!(root >= 0)) return false;
    const double part = (de_ - std::copysign(std::sqrt(root), de_)) / ee_;
    for_each_free([&](std::size_t n, double) {
      const Vec3 by = times(apart(n), -part);
      put(particles_.x, n, plus(at(particles_.x, n), by));
      put(particles_.v, n, plus(at(particles_.v, n), times(by, 1 / dt_)));
    });
    return true;
  }

  // The second order takes so much of d itself, and as much of it from velocities as leaves the speed that is asked for:
  // what is drawn steadily by a force f moves by (⅔h)² f and gains ⅔h f, where it starts by an impulse J, by h J and
  // J. Of the two that make up both, an impulse was there all along, or else it would be extrapolated.
  bool draw_smoothly(double share) {
    double dr = 0;
    for_each_free([&](std::size_t n, double mass) {
      dr += mass * dot(minus(at(particles_.x, n), x_), minus(at(particles_.v, n), v_));
    });
    const double shrunk = share * std::sqrt(ee_ / dd_), speed = kSewingSpeed / far_;
    const double part = 1 - shrunk, rate = dr / dd_ + speed * share * ee_ / (dd_ * shrunk);
    const double impulse = 3 * part / dt_ - 2 * rate;
    for_each_free([&](std::size_t n, double) {
      const Vec3 d = minus(at(particles_.x, n), x_);
      const auto [j, i] = members_[n];
      const bool goes_on = history_->goes_on(particles_, j, i);
      put(particles_.x, n, minus(at(particles_.x, n), times(d, part)));
      put(particles_.v, n, minus(at(particles_.v, n), times(d, rate)));
      for (int k = 0; goes_on && k < 3; ++k)
        history_->shift(particles_, k, j, i, 0, float(-impulse * d[std::size_t(k)]));
      if (goes_on) put(history_->v_end, n, at(particles_.v, n));
    });
    return true;
  }

  double w(std::size_t n) const { return particles_.w(members_[n].j, members_[n].i); }
  Vec3 at(const Rows& rows, std::size_t n) const {
    const auto [j, i] = members_[n];
    return {rows.at(0, j, i), rows.at(1, j, i), rows.at(2, j, i)};
  }
  void put(Rows& rows, std::size_t n, const Vec3& value) {
    for (int k = 0; k < 3; ++k)
      rows.at(k, members_[n].j, members_[n].i) = coordinate(value[std::size_t(k)]);
  }
  Vec3 mean_of(const Rows& rows) const {
    return centre(
        members_.size(), [&](std::size_t n) { return at(rows, n); },
        [&](std::size_t n) { return w(n); });
  }
  Vec3 apart(std::size_t n) const {
    const Vec3 before = history_ ? at(particles_.previous, n)
                                 : minus(at(particles_.x, n), times(at(particles_.v, n), dt_));
    return minus(before, before_);
  }
  void set(Rows& rows, const Vec3& value) {
    for_each_free([&](std::size_t n, double) { put(rows, n, value); });
  }
  // With what rounding leaves.
  void set(Rows& rows, Rows& left) {
    const Vec3 value = mean_of(rows), more = mean_of(left);
    set(rows, value);
    for_each_free([&](std::size_t n, double) {
      const auto [j, i] = members_[n];
      for (int k = 0; k < 3; ++k) {
        const auto c = std::size_t(k);
        left.at(k, j, i) = float(value[c] - double(rows.at(k, j, i)));
        move_keeping(rows.at(k, j, i), left.at(k, j, i), more[c]);
      }
    });
  }
  template <class Visit>
  void for_each_free(const Visit& visit) const {
    for (std::size_t n = 0; n < members_.size(); ++n)
      if (const double inverse = w(n); inverse > 0) visit(n, 1 / inverse);
  }

  Particles& particles_;
  const Members members_;
  const double dt_;
  History* const history_;
  const Vec3 x_, v_, before_;        // of the centre
  double far_ = 0;                   // m; of the farthest that is free, before the substep
  double ee_ = 0, de_ = 0, dd_ = 0;  // kg m²; sums of m e², m d·e, m d²
};

class Sewing final : public RowStage {
 public:
  Sewing(const ClothParts& parts, const Seams& seams, History* history, bool draws)
      : RowStage("sewing",
                 draws ? "seams draw their ends together and hold them" : "seams stay closed",
                 seams.reach(), seams.count(), "seams"),
        parts_(parts),
        seams_(seams),
        history_(history),
        draws_(draws) {}
  void run(int begin, int end, const Substep& s) override {
    const RowSpan groups = seams_.in_rows(begin, end);
    for (int g = groups.begin; g < groups.end; ++g) {
      Group group(parts_.particles, seams_.members(g), s.dt, history_);
      if (group.within_reach() || (draws_ && !group.draw())) group.join();
    }
  }

 private:
  ClothParts parts_;
  const Seams& seams_;
  History* history_;
  bool draws_;
};

class SeamSweep final : public RowStage {
 public:
  SeamSweep(const ClothParts& parts, const Seams& seams, AlignedArray<float>& records)
      : RowStage("seams", "closed ones stay closed", seams.reach(), seams.count(), "seams"),
        parts_(parts),
        seams_(seams),
        records_(records) {}
  Velocities velocities() const override { return Velocities::left_alone; }
  void run(int begin, int end, const Substep& s) override {
    const RowSpan groups = seams_.in_rows(begin, end);
    for (int g = groups.begin; g < groups.end; ++g) hold(seams_.members(g), s.dt);
  }

 private:
  float* record(const Particles::Place& p) {
    return records_.data() +
           std::size_t(kRecord) *
               (std::size_t(p.j) * std::size_t(parts_.particles.stride) + std::size_t(p.i));
  }
  void hold(Members members, double dt) {
    const auto w = [&](std::size_t n) { return double(record(members[n])[7]); };
    const auto loaded = [&](std::size_t n) {
      const float* const r = record(members[n]);
      return Vec3{r[0], r[1], r[2]};
    };
    const Vec3 began = centre(members.size(), loaded, w);
    for (std::size_t n = 0; n < members.size(); ++n)
      if (length(minus(loaded(n), began)) > kSewingSpeed * dt) return;
    const Vec3 middle = centre(
        members.size(),
        [&](std::size_t n) {
          const float* const r = record(members[n]);
          return plus(loaded(n), {r[4], r[5], r[6]});
        },
        w);
    for (std::size_t n = 0; n < members.size(); ++n) {
      if (!(w(n) > 0)) continue;
      float* const r = record(members[n]);
      for (std::size_t k = 0; k < 3; ++k) r[4 + k] = coordinate(middle[k] - double(r[k]));
    }
  }

  ClothParts parts_;
  const Seams& seams_;
  AlignedArray<float>& records_;
};

}  // namespace

// Inverse masses of a group's members.
auto Seams::weights(int group, const Particles& p) const {
  return [of = members(group), &p](std::size_t n) { return double(p.w(of[n].j, of[n].i)); };
}

Seams::Seams(const std::vector<std::vector<int>>& groups, const Particles& particles) {
  std::vector<std::vector<const std::vector<int>*>> of_row(std::size_t(particles.rows));
  for (const std::vector<int>& group : groups) {
    int low = particles.rows, high = 0;
    for (const int p : group) {
      low = std::min(low, particles.place(p).j);
      high = std::max(high, particles.place(p).j);
    }
    reach_ = std::max(reach_, high - low);
    of_row[std::size_t(low)].push_back(&group);
  }
  first_.push_back(0);
  begin_.push_back(0);
  for (const auto& row : of_row) {
    for (const std::vector<int>* group : row) {
      for (const int p : *group) members_.push_back(particles.place(p));
      first_.push_back(int(members_.size()));
    }
    begin_.push_back(count());
  }
}

double Seams::width(int group, const Particles& p) const {
  const Members of = members(group);
  const auto at = [&](std::size_t n) { return p.position(of[n].j, of[n].i); };
  const Vec3 middle = centre(of.size(), at, weights(group, p));
  double far = 0;
  for (std::size_t n = 0; n < of.size(); ++n) far = std::max(far, length(minus(at(n), middle)));
  return far;
}

OpenSeams Seams::open(const Particles& p) const {
  OpenSeams open{0, count(), 0};
  for (int g = 0; g < count(); ++g) {
    const double far = width(g, p);
    open.open += far > kOpen;
    open.widest = std::max(open.widest, far);
  }
  return open;
}

void Seams::mark_open(const Particles& p, double beyond, std::span<std::uint8_t> marks) const {
  for (int g = 0; g < count(); ++g) {
    if (!(width(g, p) > beyond)) continue;
    for (const auto& [j, i] : members(g)) marks[std::size_t(p.number(j, i))] = 1;
  }
}

void Seams::share(const Particles& p, std::vector<Vec3>& a) const {
  for (int g = 0; g < count(); ++g) {
    if (width(g, p) > kOpen) continue;
    const Members of = members(g);
    const auto own = [&](std::size_t n) -> Vec3& {
      return a[std::size_t(p.number(of[n].j, of[n].i))];
    };
    const Vec3 all = centre(of.size(), own, weights(g, p));
    for (std::size_t n = 0; n < of.size(); ++n) own(n) = all;
  }
}

std::size_t Seams::bytes() const {
  return members_.size() * sizeof(Particles::Place) + (first_.size() + begin_.size()) * sizeof(int);
}

std::unique_ptr<RowStage> make_sewing(const ClothParts& parts, const Seams& seams,
                                      History* history) {
  if (seams.count() == 0) return nullptr;
  return std::make_unique<Sewing>(parts, seams, history, true);
}

std::unique_ptr<RowStage> make_seam_hold(const ClothParts& parts, const Seams& seams,
                                         History* history) {
  if (seams.count() == 0) return nullptr;
  return std::make_unique<Sewing>(parts, seams, history, false);
}

std::unique_ptr<RowStage> make_seam_sweep(const ClothParts& parts, const Seams& seams,
                                          AlignedArray<float>& records) {
  if (seams.count() == 0) return nullptr;
  return std::make_unique<SeamSweep>(parts, seams, records);
}

}  // namespace weft::physics
