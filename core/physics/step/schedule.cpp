// The passes over a cloth's stages (schedule.h).
#include "physics/step/schedule.h"

#include <algorithm>
#include <cassert>
#include <chrono>

#include "physics/step/share_rows.h"

namespace weft::physics {
namespace {

// Rough cost of a constraint or particle, for sizing tasks only [ns].
constexpr double kItemNs = 0.5;

// From which work on several threads are faster than one. Particles times substeps, where one wavefront runs all
// substeps: threads wait for each other at every tile, which on a busy machine may take long, so a sheet is to have
// many of them, whatever they cost.
constexpr double kSharedRun = 150000, kSharedStandingBy = 30000;
// For one thread [ns]: a substep by itself, whose stages are shared out one by one; and cloths side by side.
constexpr double kSharedSubstep = 1.2e5, kApart = 6e5, kApartStandingBy = 1.2e5;

using Clock = std::chrono::steady_clock;

double nanoseconds_since(Clock::time_point before) {
  return double(
      std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - before).count());
}

double row_nanoseconds(const std::vector<RowStage*>& stages, int rows) {
  double ns = 0;
  for (const RowStage* s : stages) ns += double(s->items) * kItemNs;
  return ns / rows;
}

}  // namespace

Schedule::Schedule(const Stages& stages, int rows, std::size_t row_bytes,
                   std::optional<std::size_t> second)
    : stages_(stages), rows_(rows), second_(0) {
  std::vector<RowStage*> together;
  const auto close = [&](std::size_t end) {
    if (together.empty()) return;
    passes_.push_back(
        {end - together.size(), nullptr,
         std::make_unique<Wavefront>(together, rows, row_bytes, row_nanoseconds(together, rows)),
         together.size()});
    together.clear();
  };
  for (std::size_t q = 0; q < stages.size(); ++q) {
    if (q == second) {
      close(q);
      second_ = passes_.size();
    }
    if (RowStage* const row_stage = stages[q]->as_row_stage()) {
      together.push_back(row_stage);
      continue;
    }
    close(q);
    passes_.push_back({q, stages[q]->as_whole_stage(), nullptr, 1});
    ++whole_stages_;
  }
  close(stages.size());
  if (!second || *second >= stages.size()) second_ = passes_.size();
  for (Cost& cost : costs_)
    for (const std::unique_ptr<Stage>& s : stages) cost.alone += double(s->items) * kItemNs;
}

bool Schedule::worth_sharing(int particles, int substeps, bool standing_by, Part part) const {
  if (!rows_only() || substeps == 1) return cost(part) >= kSharedSubstep;
  return double(particles) * substeps >= (standing_by ? kSharedStandingBy : kSharedRun);
}
bool Schedule::worth_running_apart(double cost, int substeps, bool standing_by) {
  return cost * substeps >= (standing_by ? kApartStandingBy : kApart);
}

// What several threads take tells by how much the work has grown since one did it, and bounds it.
void Schedule::Cost::took(double nanoseconds, int threads) {
  if (threads == 1) {
    *this = {nanoseconds, 0};
    return;
  }
  if (shared > 0) alone *= nanoseconds / shared;
  alone = std::clamp(alone, nanoseconds, nanoseconds * threads);
  shared = nanoseconds;
}

void Schedule::run(const Substeps& given, Threads& threads, std::span<const RowSpan> awake,
                   RowObserver* observer, Part part) {
  const Clock::time_point before = Clock::now();
  run_all(given, threads, awake, observer, part);
  if (TaskRecord* record = threads.record()) record->enter("");
  costs_[std::size_t(part)].took(nanoseconds_since(before) / std::max(given.count, 1),
                                 threads.running());
}

void Schedule::run_all(const Substeps& given, Threads& threads, std::span<const RowSpan> awake,
                       RowObserver* observer, Part part) {
  assert(part == Part::whole || given.count == 1);
  if (given.dt != prepared_dt_) prepare(given.dt);
  Substeps substeps = given;
  substeps.velocities_between = velocities_between_;
  const auto tell = [&](void (RowObserver::*what)(RowSpan)) {
    if (!observer) return;
    if (TaskRecord* record = threads.record()) record->enter("");
    share_rows(threads, rows_, false, [&](RowSpan rows) { (observer->*what)(rows); });
  };
  threads.together([&] {
    if (part == Part::whole && rows_only() && !passes_.empty())
      return passes_.front().wavefront->run(substeps, threads, awake, observer);
    tell(&RowObserver::before);
    for (int s = 0; s < substeps.count; ++s) run_substep(substeps, s, threads, awake, part);
    tell(&RowObserver::after);
  });
}

// All before any runs: what stages work out of masses must not find those of the middle of a substep.
//
// What velocities gain from the sweeps at the end of a substep, where nobody looks at them but what
// predicts the next, need not be added: it can do that itself.
void Schedule::prepare(double dt) {
  prepared_dt_ = dt;
  for (Pass& p : passes_) p.whole ? p.whole->prepare(dt) : p.wavefront->prepare(dt);
  velocities_between_ =
      stages_.empty() || stages_.back()->velocities() != Velocities::from_sweeps ||
      !std::all_of(stages_.begin(), stages_.end() - 1, [&](const std::unique_ptr<Stage>& s) {
        return s->velocities() == Velocities::left_alone;
      });
}

void Schedule::run_substep(const Substeps& substeps, int s, Threads& threads,
                           std::span<const RowSpan> awake, Part part) {
  const std::size_t begin = part == Part::second ? second_ : 0;
  const std::size_t end = part == Part::first ? second_ : passes_.size();
  for (Pass& p : std::span(passes_).subspan(begin, end - begin)) {
    if (p.wavefront) {
      p.wavefront->run(substeps.only(s), threads, awake);
      continue;
    }
    if (TaskRecord* record = threads.record()) record->enter(p.whole->name);
    const Clock::time_point before = Clock::now();
    p.whole->run(substeps.at(s), threads);
    if (!profile_.empty()) profile_[p.first] += std::int64_t(nanoseconds_since(before));
  }
}

void Schedule::profile(std::span<std::atomic<std::int64_t>> nanoseconds) {
  profile_ = nanoseconds;
  for (Pass& p : passes_)
    if (p.wavefront) p.wavefront->profile(nanoseconds.subspan(p.first, p.count));
}

}  // namespace weft::physics
