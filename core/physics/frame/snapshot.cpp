// What changes while a simulation runs, taken out and put back (Snapshot).
#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <set>

#include "physics/frame/kept_run.h"
#include "physics/frame/state.h"
#include "physics/model/number.h"
#include "physics/step/keeper.h"

// A snapshot comes from a caller: every number in it is looked at before anything changes.

namespace weft {

using namespace physics;

std::size_t Snapshot::bytes() const {
  std::size_t bytes = sizeof *this;
  for (const ClothState& c : cloths)
    bytes += sizeof c + (c.positions.size() + c.velocities.size()) * sizeof(float) +
             c.held.size() * sizeof c.held[0] + c.torn.size() * sizeof c.torn[0] +
             c.inside.size() * sizeof(Inside);
  for (const std::vector<Key>& keys : paths) bytes += keys.size() * sizeof(Key);
  return bytes + (run ? sizeof *run + run->kept.size() : 0);
}

// Of a grid; a mesh counts as one row.
static int columns_of(const Cloth& cloth) {
  return cloth.mesh.given() ? particle_count(cloth) : cloth.grid.nx;
}

namespace {

// Of the bits of all that a snapshot tells (FNV-1a, by words).
class Hash {
 public:
  std::uint64_t value() const { return value_; }
  template <class T>
  void add(const std::vector<T>& values) {
    add(double(values.size()));
    for (const T& v : values) add(v);
  }
  void add(const std::array<int, 2>& pair) { add(pair[0]), add(pair[1]); }
  void add(const Snapshot::Inside& i) { add(Vec3{i.time, i.particle, i.triangle}); }
  void add(const Key& key) { add(key.time), add(key.position); }
  void add(const Vec3& v) {
    for (const double component : v) add(component);
  }
  void add(float v) { word(std::bit_cast<std::uint32_t>(v)); }
  void add(double v) { word(std::bit_cast<std::uint64_t>(v)); }
  void add(int v) { word(std::uint64_t(std::int64_t(v))); }

 private:
  void word(std::uint64_t bits) { value_ = (value_ ^ bits) * 1099511628211u; }
  std::uint64_t value_ = 14695981039346656037u;
};

std::uint64_t hash_of(const Snapshot& m) {
  Hash hash;
  hash.add(m.time);
  hash.add(m.origin);
  hash.add(m.lag);
  for (const Snapshot::ClothState& c : m.cloths) {
    hash.add(c.columns);
    hash.add(c.positions);
    hash.add(c.velocities);
    hash.add(c.held);
    hash.add(c.torn);
    hash.add(c.inside);
  }
  for (const std::vector<Key>& keys : m.paths) hash.add(keys);
  return hash.value();
}

// Whether a run of one goes on in the other, where solvers are as they were and paths as they are told.
bool goes_on_in(const Scene& a, Scene b) {
  if (a.colliders.size() != b.colliders.size()) return false;
  for (std::size_t n = 0; n < a.colliders.size(); ++n) b.colliders[n].keys = a.colliders[n].keys;
  b.solver = a.solver;
  return moves_alike(a, std::move(b));
}

}  // namespace

Snapshot Simulation::State::snapshot() {
  Snapshot m = told();
  // Which of two hands at one cloth came first is not known: its stages could not be told apart.
  const int grabbed = hands_.grabbed();
  if (grabbed >= 0 && hands_.carries(std::size_t(grabbed))) return m;
  if (!kept_scene_) kept_scene_ = std::make_shared<const Scene>(placed.given());
  auto run = std::make_shared<Snapshot::Run>();
  run->scene = kept_scene_;
  run->seed = options.seed;
  run->begun_method = began_.method;
  run->begun_solver = began_.solver;
  run->method = time_step.method;
  run->solver = scene.solver;
  run->told = hash_of(m);
  for (auto& step : cloths) run->tears.push_back(step->model().tearing() != nullptr);
  Keeper keeper;
  keep(keeper);
  run->kept = keeper.take();
  m.run = std::move(run);
  return m;
}

bool Simulation::State::goes_on(const Snapshot& m) const {
  return m.run && m.run->seed == options.seed && m.run->begun_method == began_.method &&
         m.run->begun_solver == began_.solver &&
         (m.run->scene == kept_scene_ || goes_on_in(*m.run->scene, placed.given())) &&
         m.run->told == hash_of(m);
}

bool Simulation::State::takes(const Snapshot& m) const {
  if (m.origin != placed.origin()) return false;
  for (std::size_t c = 0; m.run && c < cloths.size() && c < m.run->tears.size(); ++c)
    if (cloths[c]->model().tearing() && !m.run->tears[c]) return false;
  return true;
}

void Simulation::State::keep(Keeper& keeper) {
  keeper(time_step.substeps);
  keeper(time_step.lag);
  keeper(time_step.limit);
  keeper(time_step.followed);
  keeper(time_step.spectra);
  take_substeps(time_step.substeps);
  keeper(plan.notes);
  keeper(plan.fallback);
  keeper(total_substeps);
  keeper(greatest_strain);
  keeper(was_driven_);
  keeper(status.ok);
  keeper(status.frame);
  keeper(status.cloth);
  keeper(status.particle);
  keeper(status.stage);
  keeper(status.text);
  keeper(guard_);
  notes_.keep(keeper);
  // Where springs act, those that a snapshot tells are not those that lie behind the positions.
  for (auto& step : cloths)
    if (Particles& p = step->particles(); is_explicit(time_step.method)) p.keep(p.v, keeper);
  if (sleeping) sleeping->keep(keeper);
  hands_.keep(keeper);
  if (keeper.puts_back()) plan_changed();
  for (auto& step : cloths)
    for (const auto& stage : step->stages()) stage->keep(keeper);
  if (contact) contact->keep(keeper);
}

Snapshot Simulation::State::told() const {
  Snapshot m;
  m.time = time();
  m.origin = placed.origin();
  m.lag = is_explicit(time_step.method) ? 0 : time_step.lag;
  for (std::size_t n = 0; n < cloths.size(); ++n) {
    const Particles& p = cloths[n]->particles();
    Snapshot::ClothState c;
    c.columns = columns_of(scene.cloths[n]);
    c.positions.reserve(3 * std::size_t(p.count()));
    c.velocities.reserve(c.positions.capacity());
    for (const Vec3& v : velocities(n))
      for (const double component : v) c.velocities.push_back(float(component));
    p.for_each([&](int j, int i) {
      for (int k = 0; k < 3; ++k) c.positions.push_back(p.x.at(k, j, i));
      if (masses(n)[std::size_t(j) * p.stride + i] == 0) c.held.push_back(p.number(j, i));
    });
    if (const Tearing* tearing = cloths[n]->model().tearing()) c.torn = tearing->torn_list();
    for (const StartInside& start : cloths[n]->starts())
      c.inside.push_back({start.time, start.deepest_particle, start.deepest_triangle});
    m.cloths.push_back(std::move(c));
  }
  for (const Collider& c : placed.given().colliders) m.paths.push_back(c.keys);
  return m;
}

namespace {

constexpr double kMostFrames = 1e15;  // whole numbers are exact in double precision
constexpr double kFarthest = 1e9;     // m, of an origin; the range of places in a scene

void require(bool sound, const std::string& what) {
  if (!sound) throw std::invalid_argument("the snapshot " + what);
}

template <class Numbers>
bool all_finite(const Numbers& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](auto v) { return std::isfinite(v); });
}

void check_cloth(const Snapshot::ClothState& c, const ClothStep& step, std::size_t colliders) {
  const int particles = step.particles().count();
  const std::size_t values = 3 * std::size_t(particles);
  require(c.columns == columns_of(step.cloth()) && c.positions.size() == values &&
              c.velocities.size() == values && c.inside.size() == colliders,
          "is of another scene");
  require(all_finite(c.positions) && all_finite(c.velocities),
          "holds a position or velocity that is not finite");
  require(std::all_of(c.positions.begin(), c.positions.end(),
                      [](float x) { return std::abs(x) < kFarAway; }),
          "holds a position more than 1e7 m away");
  const auto is_there = [&](int particle) { return particle >= 0 && particle < particles; };
  for (const int particle : c.held)
    require(is_there(particle), "holds the particle " + std::to_string(particle) +
                                    " (allowed: 0 to " + std::to_string(particles - 1) + ")");
  for (const auto& [a, b] : c.torn)
    require(is_there(a) && is_there(b) && a != b,
            "has a torn constraint from particle " + std::to_string(a) + " to " +
                std::to_string(b) + " (allowed: two of 0 to " + std::to_string(particles - 1) +
                ")");
  for (const Snapshot::Inside& i : c.inside)
    require(std::isfinite(i.time) && i.particle >= 0 && i.triangle >= 0 &&
                i.particle <= kFarthest && i.triangle <= kFarthest,
            "holds a depth inside a collider that is out of range (0 to 1e9 m)");
}

}  // namespace

void Simulation::State::check(const Snapshot& m) const {
  require(m.cloths.size() == cloths.size() && m.paths.size() == scene.colliders.size(),
          "is of another scene");
  require(m.time >= 0 && m.time / scene.time.frame < kMostFrames, "has a time out of range");
  require(m.lag >= 0 && m.lag <= 1,
          "has velocities " + number(m.lag) + " s behind its positions (allowed: 0 to 1)");
  for (const double c : m.origin)
    require(std::abs(c) <= kFarthest && c == std::round(c),
            "has an origin that is not in whole meters (allowed: -1e9 to 1e9)");
  for (std::size_t n = 0; n < cloths.size(); ++n)
    check_cloth(m.cloths[n], *cloths[n], scene.colliders.size());
  Scene with_paths = placed.given();
  bool same = true;
  for (std::size_t n = 0; n < m.paths.size(); ++n) {
    std::vector<Key>& keys = with_paths.colliders[n].keys;
    same &= keys == m.paths[n];
    keys = m.paths[n];
  }
  if (same) return;
  const std::vector<Fault> faults = validate(with_paths);
  if (!faults.empty())
    throw std::invalid_argument("the snapshot's paths: " + faults[0].place + ": " + faults[0].what);
}

void Simulation::State::restore(const Snapshot& m) {
  const bool on = goes_on(m);
  hands_.let_go();
  std::vector<double> positions, velocities;
  for (std::size_t n = 0; n < cloths.size(); ++n) {
    const Snapshot::ClothState& c = m.cloths[n];
    ClothStep& step = *cloths[n];
    Particles& p = step.particles();
    wake(int(n));
    p.for_each([&](int j, int i) { p.w(j)[i] = float(1 / step.model().mass(p.number(j, i))); });
    for (const int held : c.held) p.inverse_mass[p.lane(held)] = 0;
    for (int j = 0; j < p.rows; ++j) p.weigh_row(j);
    if (sleeping) sleeping->keep_masses(int(n));
    if (!c.torn.empty() || (on && m.run->tears[n])) step.allow_tearing();
    if (Tearing* tearing = step.model().tearing()) tearing->set_torn(c.torn);
    positions.insert(positions.end(), c.positions.begin(), c.positions.end());
    velocities.insert(velocities.end(), c.velocities.begin(), c.velocities.end());
  }
  for (std::size_t n = 0; n < m.paths.size(); ++n) {
    set_path(n, m.paths[n]);
    for (std::size_t c = 0; c < cloths.size(); ++c) {
      const Snapshot::Inside& inside = m.cloths[c].inside[n];
      cloths[c]->meet(n, {inside.time, 0, 0, inside.particle, inside.triangle});
    }
  }
  frame = std::llround(m.time / scene.time.frame);
  guard_.begin_anew();
  was_driven_ = false;
  take_substeps(began_.substeps);
  if (on)
    go_on_as(m.run->method, m.run->solver);
  else
    go_on_as(began_.method, began_.solver);
  const bool forces = is_explicit(time_step.method);
  time_step.lag = forces ? time_step.dt / 2 : 0;
  time_step.followed = {};
  time_step.followed.take(began_.substeps, time());
  for (std::size_t n = 0; forces && n < cloths.size(); ++n)
    time_step.spectra[n] = cloths[n]->model().spectrum(masses(n).span());
  status = Status{};
  if (contact) contact->begin_anew();
  plan_changed();
  set(positions, m.origin, velocities, m.lag);
  if (!on) return;
  // Of what is held, too: pins on paths have velocities.
  for (std::size_t n = 0; n < cloths.size(); ++n) {
    Particles& p = cloths[n]->particles();
    auto next = m.cloths[n].velocities.begin();
    p.for_each([&](int j, int i) {
      for (int k = 0; k < 3; ++k) p.v.at(k, j, i) = *next++;
    });
  }
  Keeper keeper(m.run->kept);
  keep(keeper);
}

namespace {

// Pins of the new scene that the old one had not are held, pins it has no more are let go; what a
// hand held or let go stays so.
void change_pins(const Cloth& before, const Cloth& after, Snapshot::ClothState& cloth) {
  const auto pinned = [](const Cloth& c) {
    std::set<int> all;
    for (const Pin& p : c.pins) all.insert(particle_number(c, p));
    return all;
  };
  const std::set<int> were = pinned(before), are = pinned(after);
  std::erase_if(cloth.held, [&](int at) { return were.contains(at) && !are.contains(at); });
  const std::set<int> held(cloth.held.begin(), cloth.held.end());
  for (const Pin& p : after.pins) {
    const int at = particle_number(after, p);
    if (!were.contains(at) && !held.contains(at)) cloth.held.push_back(at);
  }
}

using Torn = std::vector<std::array<int, 2>>;
Torn sorted(Torn torn) {
  std::sort(torn.begin(), torn.end());
  return torn;
}

// What only the old scene's cuts took is whole again; what the new scene's take is gone.
void change_cuts(const Torn& before, const Torn& after, Torn& torn) {
  Torn kept, all;
  const Torn now = sorted(std::move(torn)), old = sorted(before), next = sorted(after);
  std::set_difference(now.begin(), now.end(), old.begin(), old.end(), std::back_inserter(kept));
  std::set_union(kept.begin(), kept.end(), next.begin(), next.end(), std::back_inserter(all));
  torn = std::move(all);
}

}  // namespace

void Simulation::set_scene(Scene scene) {
  Simulation next(std::move(scene), state_->options);
  const Scene after = next.scene();
  Scene before = this->scene();
  weft::draw_as(after, before);
  bool same = before.cloths.size() == after.cloths.size();
  for (std::size_t n = 0; same && n < after.cloths.size(); ++n)
    same = columns_of(before.cloths[n]) == columns_of(after.cloths[n]) &&
           particle_count(before.cloths[n]) == particle_count(after.cloths[n]);
  if (same) {
    Snapshot m = state_->told();
    for (std::size_t n = 0; n < after.cloths.size(); ++n)
      if (before.cloths[n].pins != after.cloths[n].pins)
        change_pins(state_->scene.cloths[n], next.state_->scene.cloths[n], m.cloths[n]);
    for (std::size_t n = 0; n < after.cloths.size(); ++n)
      if (before.cloths[n].cuts != after.cloths[n].cuts)
        change_cuts(state_->cut_from_start[n], next.state_->cut_from_start[n], m.cloths[n].torn);
    m.paths.clear();
    for (const Collider& c : after.colliders) m.paths.push_back(c.keys);
    for (Snapshot::ClothState& c : m.cloths) c.inside.resize(after.colliders.size());
    next.restore(m);
    for (std::size_t k = 0; k < after.colliders.size(); ++k)
      if (k >= before.colliders.size() || before.colliders[k] != after.colliders[k])
        next.state_->meet(k);
    next.state_->changes += state_->changes;
  }
  *this = std::move(next);
}

Snapshot Simulation::snapshot() const {
  return state_->snapshot();
}
// About the snapshot's origin, wherever the scene would have its own: cloths stay as fine as they were. Cloths that
// could not tear then have other stages once they can.
void Simulation::restore(const Snapshot& snapshot) {
  state_->check(snapshot);
  if (state_->takes(snapshot)) return state_->restore(snapshot);
  auto next = std::make_unique<State>(scene(), state_->options, snapshot.origin);
  next->restore(snapshot);
  next->changes += state_->changes;
  state_ = std::move(next);
}

}  // namespace weft
