// Grids, method and substeps for an asked distance from the sheet over a whole run (search.h).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scene/json_text.h"
#include "tolerance/search.h"
#include "weft/estimate.h"

namespace weft::tolerance {
namespace {

constexpr int kFirst = 4;  // intervals along the longest side of the coarsest grid that is tried
constexpr int kMostIntervals = 4095;
constexpr double kBytes = 1000;  // that a particle takes, with what is kept of its places
// Of a ladder: two orders are seen, and all four take a sixth of the work of what is twice as fine as the last.
constexpr int kRungs = 4;
// Of distances between grids. With 1 a fourth of random sheets were up to a tenth beyond what was promised
// (bench/tolerance --grids).
constexpr double kSafety = 1.25;
constexpr int kTries = 6;           // ladders
constexpr double kMostWork = 1e11;  // of a rung, Trial::work; about two minutes on one thread

// All grids of a scene at once. Cells keep their shape, for springs are another material in cells of another, and what
// is held its places, as far as coarse grids can.
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

  // About so many times as fine as the scene's, or finer where coarser cells would have another shape.
  std::vector<Intervals> at(double scale) const {
    std::vector<Intervals> all;
    for (std::size_t c = 0; c < own_.size(); ++c) all.push_back(at(scale, own_[c], units_[c]));
    return all;
  }
  double coarsest() const { return double(kFirst) / longest_; }
  // Whether grids so many times as fine as these have no more points than a grid can have, and no more particles than
  // memory has room for.
  static bool allowed(const std::vector<Intervals>& from, int times) {
    double particles = 0;
    for (const Intervals& i : from) {
      if (std::max(i.u, i.v) > kMostIntervals / times) return false;
      particles += (double(i.u) * times + 1) * (double(i.v) * times + 1);
    }
    return particles * kBytes < free_memory();
  }

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
  static Intervals at(double scale, const Intervals& own, const Intervals& unit) {
    constexpr double kShape =
        0.02;  // by so much sides of cells may differ; springs along them differ as much
    const double shape = double(own.v) / own.u;
    int u = unit.u * std::max(1, int(std::lround(scale * own.u / unit.u)));
    for (; u < own.u; u += unit.u) {
      const int v = unit.v * std::max(1, int(std::lround(u * shape / unit.v)));
      if (std::abs(v / (u * shape) - 1) <= kShape) return {u, v};
    }
    const int times = std::max(1, int(std::lround(scale)));
    return {own.u * times, own.v * times};
  }
  const Scene& scene_;
  std::vector<Intervals> own_, units_;
  int longest_ = 1;
};

std::vector<Intervals> finer(std::vector<Intervals> intervals, int times) {
  for (Intervals& i : intervals) i.u *= times, i.v *= times;
  return intervals;
}

constexpr const char* kTooFine = "needs finer grids than there can be";

// What a way comes to on coarse grids, and what follows from that.
struct Outlook {
  Way way;
  double scale = 1;  // of the grids that keep the error, of the scene's
  double work = kAnyWork;
  Search seen;  // of the finest grids that were tried
  double tried_work = 0;
};

class GridSearch {
 public:
  GridSearch(const Asked& asked, Choice& choice)
      : asked_(asked), grids_(asked.scene), choice_(choice) {}

  // `best`: of another way.
  Outlook outlook(const Way& way, const Outlook* best) {
    Outlook o{way, 1, kAnyWork, {trial_of(way)}, 0};
    Trial& t = o.seen.trial;
    const double first = grids_.coarsest();
    const std::vector<Intervals> grids = grids_.at(first);
    if (!Grids::allowed(grids, kFinest)) {
      t.why = kTooFine;
      return o;
    }
    const double most_work = best ? best->work * std::pow(2 * first / best->scale, 3) : kAnyWork;
    const InTime in_time = substeps(way, grids, most_work);
    if (!in_time.kept) {
      t.why = in_time.why;
      return o;
    }
    const Ladder rungs = ladder(way, grids, in_time.substeps);
    if (!std::isfinite(rungs.error())) return o;
    t.why.clear();
    t.error = rungs.error(), t.order = rungs.order();
    t.substeps = rungs.finest().substeps, t.intervals = rungs.finest().grids;
    o.seen.falls = rungs.falls();
    const double times = std::max(fineness(t.error, t.order), 1.0 / kFinest);
    o.tried_work = rungs.finest().work;
    o.scale = first * kFinest * times;
    o.work = rungs.finest().work * std::pow(times, 3);
    return o;
  }

  // Ladders to about half as fine as the outlook, each nearer to what is asked, until one tells what keeps it.
  Search find(const Outlook& o) {
    Search search = o.seen;
    Trial& t = search.trial;
    double scale = o.scale, tried = grids_.coarsest() * kFinest, work = o.tried_work;
    for (int n = 0; n < kTries && (n == 0 || search.falls); ++n) {
      // No more than twice as fine as the last ladder: orders of coarse grids are low, and tell of too fine ones.
      const double fine = std::clamp(scale / 2, grids_.coarsest() * kFinest, 2 * tried);
      const std::vector<Intervals> grids = grids_.at(fine / kFinest);
      if (!Grids::allowed(grids, 2 * kFinest)) {
        t.why = kTooFine;
        return search;
      }
      if (work * std::pow(fine / tried, 3) > kMostWork) {
        t.why = "would take too long to find out";
        return search;
      }
      const InTime in_time = substeps(o.way, grids, kAnyWork);
      if (!in_time.kept) return search;
      const Ladder rungs = ladder(o.way, grids, in_time.substeps);
      const std::optional<double> times = rungs.needed((asked_.error - in_time.error) / kSafety);
      search.falls = rungs.falls();
      // On the way that the rungs go, for cells of one shape.
      const int finer_than_first = times ? int(std::ceil(kFinest * *times)) : kFinest;
      const double really = double(finer_than_first) / kFinest;
      t.intervals = finer(grids, finer_than_first);
      t.error = rungs.error(really) + in_time.error, t.order = rungs.order();
      t.substeps = rungs.finest().substeps;
      t.kept = times.has_value();
      if (times) return finished(search, o.way, really);
      tried = fine, work = rungs.finest().work;
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
    double error = 0;   // m
    std::string why{};  // it is not kept
  };

  double fineness(double error, double order) const {
    constexpr double kMargin = 1.5;
    return std::pow(kMargin * error / asked_.error, 1 / std::max(order, 0.5));
  }

  Ladder ladder(const Way& way, const std::vector<Intervals>& first, int substeps) {
    Ladder ladder(2);
    for (int rung = 0; rung < kRungs; ++rung) {
      ladder.add(
          motion_of(grids_.scene(finer(first, 1 << rung)), way, substeps << rung, asked_.runs));
      choice_.trial_work += ladder.finest().work;
    }
    return ladder;
  }

  // The error in time of what is implicit goes with dt/h, by what sweeps leave, and with dt: halving both hardly
  // changes it, and no ladder of both shows it. So it is asked for by itself, on the second rung of a ladder.
  InTime substeps(const Way& way, const std::vector<Intervals>& grids, double most_work) {
    constexpr double kShare =
        1 / 3.0;  // cheapest where work is the square of one fineness times the other
    if (way.is_explicit()) return {};
    const Scene scene = grids_.scene(finer(grids, 2));
    const Asked in_time{scene, kShare * asked_.error, asked_.runs};
    const Way& first = ways_.front();
    Search s{trial_of(way)};
    if (first_substeps(scene, first, asked_.runs.options) <= kMostOfTruth) {
      Truth truth;
      choice_.trial_work += find_explicit(in_time, first, truth).work;
      s = find_against(in_time, way, truth, most_work);
    } else {
      s = find_implicit(in_time, way, most_work);
    }
    choice_.trial_work += s.work;
    const std::string& why = s.trial.why;
    return {s.trial.kept, (s.trial.substeps + 1) / 2, s.trial.error,
            why.empty() ? "would take more work" : why};
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
  Search failed = outlooks.front().seen;
  for (const Outlook& o : outlooks) {
    Search s = o.seen;
    if (o.work < least) {
      s = searches.find(o);
      if (&o == &outlooks.front()) failed = s;
    } else if (s.trial.why.empty()) {
      s.trial.why = "would take more work";
    }
    choice.trials.push_back(s.trial);
    if (!s.trial.kept || s.trial.work >= least) continue;
    least = s.trial.work;
    choice.best = int(choice.trials.size()) - 1;
  }
  if (choice.best < 0) {
    choice.notes.push_back(not_promised(asked, failed, "grids and substeps"));
    return choice;
  }
  choice.promised = true;
  for (std::size_t c = 0; c < asked.scene.cloths.size(); ++c) {
    const Cloth& cloth = asked.scene.cloths[c];
    const std::string name = "cloth " + std::to_string(c);
    if (cloth.grid.jitter > 0)
      choice.notes.push_back(name + ": its jitter is another on every grid");
    if (cloth.bending.given()) continue;
    choice.promised = false;
    choice.notes.push_back(
        name +
        " has no bending: where it is pushed together it wrinkles as finely as its grid "
        "can, finer grids have finer wrinkles, and no error is promised");
  }
  take(choice, searches.grids(), choice.trials[std::size_t(choice.best)]);
  return choice;
}

}  // namespace weft::tolerance
