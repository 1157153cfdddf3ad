// The frame: substeps through the plan, the substep kept inside the stability limit, and a stop with
// the place of the fault when the state turns non-finite.
#include "physics/state.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "physics/energy.h"
#include "physics/stability.h"

namespace weft {

using namespace physics;

namespace {

constexpr double kLimitShare = 0.9;      // of the stability limit that an automatic substep takes
constexpr int kMostSubsteps = 100000;    // per frame
constexpr double kProjectionRate = 960;  // automatic substeps a second of the projecting methods
constexpr int kSmallCloth = 4096;        // particles up to which one thread is faster
constexpr double kGrabbed = 0.6;         // of follow_stretch's t, room for what a hand may do in a frame
constexpr float kFarAway = 1e7f;         // m; nothing in a sane scene gets there

Simd resolve(Simd simd) {
  if (simd != Simd::best) return simd;
  for (Simd s : {Simd::avx512, Simd::avx2})
    if (simd_available(s)) return s;
  return Simd::sse2;
}

// Without shear springs (or with nothing else) a sheet folds onto a line that stretches nothing, where
// all its springs pull the same way: up to twice the flat sheet's ω², and no stretch adds to that.
constexpr double kFolded = 2;
bool folds_freely(const ClothStep& step) {
  const auto has = [&](Kind kind) {
    return std::any_of(step.families().begin(), step.families().end(),
                       [&](const Family& f) { return f.kind == kind; });
  };
  return !has(Kind::structural) || !has(Kind::shear);
}

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", v);
  return text;
}

}  // namespace

Simulation::State::State(Scene given, const Options& given_options)
    : scene(std::move(given)),
      options(given_options),
      simd(resolve(options.simd)),
      threads(options.threads),
      one_thread(1),
      method(scene.solver.method) {
  build_cloths();
  choose_method_and_substeps();
  frame_ms.reserve(std::size_t(std::clamp(scene.time.seconds / scene.time.frame, 1.0, 1e6)) + 1);
}

void Simulation::State::build_cloths() {
  cloths.clear();
  backups_.clear();
  stage_ns.clear();
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    cloths.push_back(std::make_unique<ClothStep>(scene, int(c), method, options.seed,
                                                 kernel_table(simd)));
    const Lattice& l = cloths.back()->lattice();
    backups_.push_back({Rows(l.rows, l.stride), Rows(l.rows, l.stride)});
    stage_ns.emplace_back(cloths.back()->stages().size());
    if (options.profile) cloths.back()->passes().profile(stage_ns.back());
  }
  self_collision = SelfContact::make(scene, cloths, kernel_table(simd));
}

// Explicit springs: the substep from the stability limit, or the user's if it is inside; beyond it,
// the compliant method in their place, which is stable at any substep.
void Simulation::State::choose_method_and_substeps() {
  std::vector<std::string> notes;
  for (const Cloth& c : scene.cloths)
    if (c.self_collision.mode == SelfCollisionMode::surface) {
      notes.push_back("self_collision: surface is not available yet; particles runs in its place");
      break;
    }
  int count = scene.time.substeps;
  double limit = 0;
  if (is_explicit(method)) {
    limit = std::numeric_limits<double>::infinity();
    double safe = limit;  // for automatic substeps
    for (const auto& c : cloths) {
      spectra.push_back(estimate_spectrum(c->cloth(), c->families(), c->lattice(),
                                          method == Method::spring_friction));
      limit = std::min(limit, spectra.back().largest_substep());
      Spectrum folded = spectra.back();
      if (folds_freely(*c)) folded.omega_squared *= kFolded;
      safe = std::min(safe, folded.largest_substep());
    }
    const double needed = std::ceil(scene.time.frame / (kLimitShare * safe));
    if (count == kAutoSubsteps && needed <= kMostSubsteps) {
      count = std::max(1, int(needed));
      notes.push_back("substeps from the stability limit of " + number(limit) + " s");
    } else if (count == kAutoSubsteps || scene.time.frame / count > limit) {
      notes.push_back("springs need substeps below " + number(limit) + " s, " +
                      number(needed) + " a frame at " + number(kLimitShare) +
                      " of the limit; the compliant method runs in their place");
      method = Method::compliant;
      build_cloths();
    }
  }
  if (count == kAutoSubsteps) count = std::max(1, int(std::lround(scene.time.frame * kProjectionRate)));
  Scene as_run = scene;
  as_run.solver.method = method;
  plan = describe(as_run, cloths, count);
  plan.dt_limit = std::isfinite(limit) ? limit : 0;
  plan.notes = std::move(notes);
  substeps = count;
  dt = scene.time.frame / count;
  if (is_explicit(method)) shift_velocities(-dt / 2);
}

// v <- v + a·by: velocities of explicit springs lie half a substep behind the positions. `from`
// gives all velocities in double in place of v, so that what velocities() told comes back exactly.
void Simulation::State::shift_velocities(double by, const double* from) {
  for (auto& step : cloths) {
    Lattice& l = step->lattice();
    std::vector<Vec3>& a = accelerations_;
    accelerations(scene, step->cloth(), step->families(), l, method == Method::spring_friction, a);
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i)
        for (int c = 0; c < 3; ++c) {
          float& v = l.v.at(c, j, i);
          const double start = from && l.w(j, i) > 0 ? *from : v;
          v = float(start + a[std::size_t(j) * l.columns + i][c] * by);
          if (from) ++from;
        }
  }
  if (scene.time.substeps != kAutoSubsteps) accelerations_ = std::vector<Vec3>();
}

void Simulation::State::set_substeps(int count) {
  const double before = dt;
  substeps = std::min(count, kMostSubsteps);
  dt = scene.time.frame / substeps;
  shift_velocities((before - dt) / 2);
  plan.substeps = substeps;
  plan.dt = dt;
  for (PlannedStage& s : plan.stages) s.calls_per_frame = substeps;
}

void Simulation::State::advance_frame() {
  if (!status.ok) return;
  const auto start = std::chrono::steady_clock::now();
  save();
  run_frame();
  if (!finite()) {
    find_fault();
    restore();
    return;
  }
  for (auto& step : cloths)
    if (step->topology()) step->topology()->update();
  ++frame;
  total_substeps += substeps;
  if (is_explicit(method) && scene.time.substeps == kAutoSubsteps) follow_stretch();
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  total_ms += spent.count();
  // A run longer than the scene says keeps the times of its last frames.
  if (frame_ms.size() < frame_ms.capacity())
    frame_ms.push_back(float(spent.count()));
  else
    frame_ms[std::size_t(frame) % frame_ms.size()] = float(spent.count());
}

void Simulation::State::run_frame() {
  if (!self_collision) return run_substeps(0, substeps);
  for (int s = 0; s < substeps;) {
    const int count = std::min(until_collision_ - since_collision_, substeps - s);
    run_substeps(s, count);
    s += count;
    since_collision_ += count;
    if (since_collision_ < until_collision_) break;
    const auto start = std::chrono::steady_clock::now();
    until_collision_ = self_collision->run(dt, since_collision_, threads);
    since_collision_ = 0;
    const auto spent = std::chrono::steady_clock::now() - start;
    self_collision_ns += std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count();
    ++self_collision_runs;
  }
}

void Simulation::State::run_substeps(int first, int count) {
  const double time = double(frame) * scene.time.frame + first * dt;
  for (auto& step : cloths) {
    const Lattice& l = step->lattice();
    const bool small = l.columns * l.rows <= kSmallCloth;
    step->passes().run(time, dt, count, small ? one_thread : threads);
  }
}

// Stretched springs resist sideways too, which raises the largest frequency:
// ω² <= ω²_flat + t (ω²_all - ω²_flat), t = max (1 - l/|e|). Every fourth row is looked at.
void Simulation::State::follow_stretch() {
  double limit = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const ClothStep& step = *cloths[c];
    const Lattice& l = step.lattice();
    float most = 0;
    for (const Family& f : step.families()) {
      if (f.kind != Kind::structural) continue;
      for (int j = 0; j + f.dj < l.rows; j += 4)
        for (int n = 0; n < f.per_row(l.columns); ++n) {
          if (!f.alive(j, n)) continue;
          float squared = 0;
          for (int k = 0; k < 3; ++k) {
            const float e = l.x.at(k, j + f.dj, n + f.far()) - l.x.at(k, j, n + f.near());
            squared += e * e;
          }
          most = std::max(most, squared / float(f.rest * f.rest));
        }
    }
    double t = most > 1 ? 1 - 1 / std::sqrt(double(most)) : 0;
    if (grab_) t = std::max(t, kGrabbed);
    // Springs in all directions: never more than twice the flat sheet's ω² for the families here.
    Spectrum stretched = spectra[c];
    stretched.omega_squared *= folds_freely(step) ? kFolded : 1 + t;
    limit = std::min(limit, stretched.largest_substep());
  }
  const int count = int(std::ceil(scene.time.frame / (kLimitShare * limit)));
  // A few percent of slack either way keeps the substep from changing every frame.
  if (count > substeps || count < substeps - substeps / 12) set_substeps(std::max(1, count));
}

void Simulation::State::set(std::span<const double> positions, std::span<const double> velocities) {
  std::size_t particles = 0;
  for (const auto& step : cloths)
    particles += std::size_t(step->lattice().columns) * step->lattice().rows;
  if (positions.size() != 3 * particles || velocities.size() != 3 * particles)
    throw std::invalid_argument("a state needs " + std::to_string(3 * particles) +
                                " positions and as many velocities");
  const auto bad = [](double v) { return !(std::abs(v) <= std::numeric_limits<float>::max()); };
  if (std::any_of(positions.begin(), positions.end(), bad) ||
      std::any_of(velocities.begin(), velocities.end(), bad))
    throw std::invalid_argument("a state holds a value that is not finite");
  std::size_t p = 0;
  for (auto& step : cloths) {
    Lattice& l = step->lattice();
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i, ++p)
        for (int c = 0; c < 3; ++c) {
          l.x.at(c, j, i) = float(positions[3 * p + c]);
          l.v.at(c, j, i) = l.w(j, i) > 0 ? float(velocities[3 * p + c]) : 0;
        }
  }
  for (auto& step : cloths)
    for (const auto& stage : step->stages()) stage->restart();
  if (self_collision) self_collision->restart();
  since_collision_ = 0;
  until_collision_ = 1;
  if (is_explicit(method)) {
    shift_velocities(-dt / 2, velocities.data());
    if (scene.time.substeps == kAutoSubsteps) follow_stretch();
  }
  ++changes;
}

void Simulation::State::save() {
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    backups_[c].x.copy(cloths[c]->lattice().x);
    backups_[c].v.copy(cloths[c]->lattice().v);
  }
}

void Simulation::State::restore() {
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    cloths[c]->lattice().x.copy(backups_[c].x);
    cloths[c]->lattice().v.copy(backups_[c].v);
  }
}

std::size_t Simulation::State::backup_bytes() const {
  std::size_t bytes = accelerations_.capacity() * sizeof(Vec3);
  for (const Backup& b : backups_) bytes += b.x.bytes() + b.v.bytes();
  return bytes;
}

bool Simulation::State::finite() const {
  for (const auto& step : cloths)
    if (!step->lattice().x.all_within(kFarAway) ) return false;
  return true;
}

// Runs the frame again, stage by stage, to the first that leaves a particle non-finite.
void Simulation::State::find_fault() {
  restore();
  status.ok = false;
  status.frame = frame + 1;
  status.stage = "step";
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    Lattice& l = cloths[c]->lattice();
    for (int s = 0; s < substeps; ++s) {
      const Substep substep{dt, double(frame) * scene.time.frame + (s + 1) * dt, 0};
      for (const auto& stage : cloths[c]->stages()) {
        stage->run_alone(l.rows, substep, threads);
        for (int j = 0; j < l.rows && status.text == "ok"; ++j)
          for (int i = 0; i < l.columns && status.text == "ok"; ++i)
            for (int k = 0; k < 3; ++k)
              if (!(std::abs(l.x.at(k, j, i)) < kFarAway) || !std::isfinite(l.v.at(k, j, i))) {
                status.stage = stage->name;
                status.cloth = int(c);
                status.i = i;
                status.j = j;
                status.text = "not finite in frame " + std::to_string(status.frame) + ", substep " +
                              std::to_string(s + 1) + ", stage " + stage->name + ", cloth " +
                              std::to_string(c) + ", particle [" + std::to_string(i) + "," +
                              std::to_string(j) + "]";
                break;
              }
        if (status.text != "ok") return;
      }
    }
  }
  // Every stage stays finite by itself: what runs between them does not.
  status.stage = self_collision ? "self_collision" : "step";
  status.text = "not finite in frame " + std::to_string(status.frame) + ", stage " + status.stage;
}

}  // namespace weft
