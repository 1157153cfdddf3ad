// Grids, method and substeps for an asked distance from the sheet over a whole run (search.h).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scene/json_text.h"
#include "tolerance/search.h"

namespace weft::tolerance {
namespace {

constexpr int kFirst = 4;  // intervals along the longest side of the coarsest grid that is tried
constexpr int kLeast = 2;  // along any side
constexpr int kMostIntervals = 4095;
// Of a ladder: two orders are seen, and all four take a sixth of the work of what is twice as fine as the last.
constexpr int kRungs = 4;
// Of distances between grids. With 1 a fourth of random sheets were up to a tenth beyond what was promised
// (bench/tolerance --grids).
constexpr double kSafety = 1.25;
constexpr int kTries = 6;  // ladders

// All grids of a scene at once. Sides keep their ratios, and what is held its places, as far as coarse grids can.
class Grids {
 public:
  explicit Grids(const Scene& scene) : scene_(scene) {
    for (const Cloth& cloth : scene.cloths) {
      own_.push_back({cloth.grid.nx - 1, cloth.grid.ny - 1});
      Intervals unit = intervals_of_pins(cloth);
      // Where only the grid itself has all its pins, they move to the nearest particle.
      if (unit.u == own_.back().u) unit.u = 1;
      if (unit.v == own_.back().v) unit.v = 1;
      units_.push_back(unit);
      longest_ = std::max({longest_, own_.back().u, own_.back().v});
    }
  }

  // So many times as fine as the scene's.
  std::vector<Intervals> at(double scale) const {
    std::vector<Intervals> all;
    for (std::size_t c = 0; c < own_.size(); ++c)
      all.push_back(
          {rounded(own_[c].u, units_[c].u, scale), rounded(own_[c].v, units_[c].v, scale)});
    return all;
  }
  // Others so many times as fine as grids of these.
  std::vector<Intervals> refined(std::vector<Intervals> from, double times) const {
    for (std::size_t c = 0; c < from.size(); ++c) {
      from[c].u = rounded(from[c].u, units_[c].u, times);
      from[c].v = rounded(from[c].v, units_[c].v, times);
    }
    return from;
  }
  double coarsest() const { return double(kFirst) / longest_; }
  bool allowed(double scale) const { return scale * longest_ <= kMostIntervals; }

  Scene scene(const std::vector<Intervals>& intervals,
              std::vector<std::string>* notes = nullptr) const {
    Scene scene = scene_;
    for (std::size_t c = 0; c < intervals.size(); ++c) {
      RegriddedCloth other = with_intervals(scene_.cloths[c], intervals[c]);
      scene.cloths[c] = std::move(other.cloth);
      if (!notes) continue;
      for (const std::string& note : other.notes)
        notes->push_back("cloth " + std::to_string(c) + ": " + note);
    }
    return scene;
  }

 private:
  static int rounded(int own, int unit, double scale) {
    const int least = std::min(own, (kLeast + unit - 1) / unit * unit);
    return std::clamp(unit * int(std::lround(scale * own / unit)), least, kMostIntervals);
  }
  const Scene& scene_;
  std::vector<Intervals> own_, units_;
  int longest_ = 1;
};

std::vector<Intervals> finer(std::vector<Intervals> intervals, int times) {
  for (Intervals& i : intervals) i.u *= times, i.v *= times;
  return intervals;
}

// What a way comes to on coarse grids, and what follows from that.
struct Outlook {
  Way way;
  double scale = 1;  // of the grids that keep the error, of the scene's
  double work = kAnyWork;
  bool more_work = false;  // than another way's, which `work` then is: nothing else is known
  // Of the finest grids that were tried.
  int substeps = 0;
  std::vector<Intervals> intervals;
  bool falls = true;
  double error = std::numeric_limits<double>::infinity(), order = 0;
};

Search as_seen(const Outlook& o) {
  Search s{trial_of(o.way)};
  s.trial.substeps = o.substeps, s.trial.intervals = o.intervals;
  s.trial.error = o.error, s.trial.order = o.order, s.trial.work = o.work;
  s.falls = o.falls;
  return s;
}

class GridSearch {
 public:
  GridSearch(const Asked& asked, Choice& choice)
      : asked_(asked), grids_(asked.scene), choice_(choice) {}

  // `best`: of another way.
  Outlook outlook(const Way& way, const Outlook* best) {
    Outlook o;
    o.way = way;
    const double first = grids_.coarsest();
    const double most_work = best ? best->work * std::pow(2 * first / best->scale, 3) : kAnyWork;
    const InTime in_time = substeps(way, first, most_work);
    if (!in_time.kept) {
      o.more_work = best != nullptr;
      if (best) o.work = best->work;
      return o;
    }
    const Ladder rungs = ladder(way, first, in_time.substeps);
    o.error = rungs.error(), o.order = rungs.order();
    o.substeps = rungs.finest().substeps, o.intervals = rungs.finest().grids,
    o.falls = rungs.falls();
    if (!std::isfinite(o.error)) return o;
    const double times = fineness(o.error, o.order);
    o.scale = first * kFinest * times;
    o.work = rungs.finest().work * std::pow(times, 3);
    return o;
  }

  // Ladders to about half as fine as the outlook, each nearer to what is asked, until one tells what keeps it.
  Search find(const Outlook& o) {
    Search search = as_seen(o);
    Trial& t = search.trial;
    double scale = o.scale, tried = grids_.coarsest() * kFinest;
    for (int n = 0; n < kTries && search.falls && grids_.allowed(scale); ++n) {
      // No more than twice as fine as the last ladder: orders of coarse grids are low, and tell of too fine ones.
      const double fine = std::clamp(scale / 2, grids_.coarsest() * kFinest, 2 * tried);
      const double first = fine / kFinest;
      const InTime in_time = substeps(o.way, first, kAnyWork);
      if (!in_time.kept) return search;
      const Ladder rungs = ladder(o.way, first, in_time.substeps);
      const std::optional<double> times = rungs.needed((asked_.error - in_time.error) / kSafety);
      search.falls = rungs.falls();
      t.intervals = grids_.refined(rungs.finest().grids, times.value_or(1));
      t.error = rungs.error(times.value_or(1)) + in_time.error, t.order = rungs.order();
      t.substeps = rungs.finest().substeps;
      t.kept = times.has_value();
      if (times) return finished(search, o.way, *times);
      tried = fine;
      scale =
          std::isfinite(t.error) ? std::max(fine * fineness(t.error, t.order), 3 * fine) : 4 * fine;
    }
    return search;
  }

  const Grids& grids() const { return grids_; }

 private:
  static constexpr int kFinest =
      1 << (kRungs - 1);  // times as fine as its first rung is a ladder's last

  // Substeps on the first rung of a ladder, and the error that is left to them: that of explicit ones, which go with
  // the stability limit, is a part of the ladder's own.
  struct InTime {
    bool kept = true;
    int substeps = kAutoSubsteps;
    double error = 0;  // m
  };

  double fineness(double error, double order) const {
    constexpr double kMargin = 1.5;
    return std::pow(kMargin * error / asked_.error, 1 / std::max(order, 0.5));
  }

  Ladder ladder(const Way& way, double scale, int substeps) {
    Ladder ladder(2);
    const std::vector<Intervals> first = grids_.at(scale);
    for (int rung = 0; rung < kRungs; ++rung) {
      ladder.add(
          motion_of(grids_.scene(finer(first, 1 << rung)), way, substeps << rung, asked_.runs));
      choice_.trial_work += ladder.finest().work;
    }
    return ladder;
  }

  // The error in time of what is implicit goes with dt/h, by what sweeps leave, and with dt: halving both hardly
  // changes it, and no ladder of both shows it. So it is asked for by itself, on the second rung of a ladder.
  InTime substeps(const Way& way, double scale, double most_work) {
    constexpr double kShare =
        1 / 3.0;  // cheapest where work is the square of one fineness times the other
    if (way.is_explicit()) return {};
    const Scene scene = grids_.scene(finer(grids_.at(scale), 2));
    const Asked in_time{scene, kShare * asked_.error, asked_.runs};
    const Way& first = ways_.front();
    Search s;
    if (first_substeps(scene, first, asked_.runs.options) <= kMostOfTruth) {
      Truth truth;
      const Search of_truth = find_explicit(in_time, first, truth);
      choice_.trial_work += of_truth.work;
      if (!of_truth.trial.kept) return {false};
      s = find_against(in_time, way, truth, most_work);
    } else {
      s = find_implicit(in_time, way, most_work);
    }
    choice_.trial_work += s.work;
    return {s.trial.kept, (s.trial.substeps + 1) / 2, s.trial.error};
  }

  Search finished(Search search, const Way& way, double times) const {
    Trial& t = search.trial;
    const Scene scene = grids_.scene(t.intervals);
    t.substeps = way.is_explicit() ? first_substeps(scene, way, asked_.runs.options)
                                   : int(std::ceil(t.substeps * times));
    double particles = 0;
    for (const Cloth& cloth : scene.cloths) particles += particle_count(cloth);
    t.work = way.work * particles * t.substeps * asked_.runs.frames;
    return search;
  }

  const Asked& asked_;
  std::vector<Way> ways_ = ways_of(asked_.scene);
  Grids grids_;
  Choice& choice_;
};

void take(Choice& choice, const Grids& grids, const Trial& trial) {
  choice.scene = grids.scene(trial.intervals, &choice.notes);
  choice.scene.solver = trial.solver;
  choice.scene.time.substeps =
      trial.solver.method == Method::compliant ? trial.substeps : kAutoSubsteps;
}

}  // namespace

Choice choose_grids(const Asked& asked) {
  Choice choice;
  choice.scene = asked.scene;
  choice.tried = asked.runs.frames * asked.scene.time.frame;
  GridSearch searches(asked, choice);
  std::vector<Outlook> outlooks;
  for (const Way& way : ways_of(asked.scene)) {
    const auto best = std::ranges::min_element(outlooks, {}, &Outlook::work);
    const bool works = best != outlooks.end() && std::isfinite(best->work);
    outlooks.push_back(searches.outlook(way, works ? &*best : nullptr));
  }
  std::ranges::stable_sort(outlooks, {}, &Outlook::work);
  double least = kAnyWork;
  std::optional<Search> failed;  // the first
  for (const Outlook& o : outlooks) {
    Search s = as_seen(o);
    if (std::isfinite(o.work) && o.work < least && !o.more_work) {
      s = searches.find(o);
      if (!s.trial.kept && !failed) failed = s;
    }
    choice.trials.push_back(s.trial);
    if (!s.trial.kept || s.trial.work >= least) continue;
    least = s.trial.work;
    choice.best = int(choice.trials.size()) - 1;
  }
  if (choice.best >= 0) {
    for (std::size_t c = 0; c < asked.scene.cloths.size(); ++c)
      if (!asked.scene.cloths[c].bending.given())
        choice.notes.push_back(
            "cloth " + std::to_string(c) +
            " has no bending: where it is pushed together it wrinkles as finely as its grid can, "
            "finer grids have finer wrinkles, and no error is promised");
    choice.promised = choice.notes.empty();
    take(choice, searches.grids(), choice.trials[std::size_t(choice.best)]);
  } else if (failed) {
    choice.notes.push_back(not_promised(asked, *failed, "grids and substeps"));
  }
  return choice;
}

}  // namespace weft::tolerance
