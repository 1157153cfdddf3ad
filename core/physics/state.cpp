// The frame: substeps through the plan, and a stop with the place of the fault when the state turns
// non-finite.
#include "physics/state.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "physics/colliders/shapes.h"
#include "physics/energy.h"
#include "physics/stages/colliders.h"
#include "physics/support.h"

namespace weft {

using namespace physics;

namespace {

// Of the springs' stability limit, between two runs of self-collision. Their shortest period is π of it:
// with more than that in between, they push what lies on each other ever livelier.
constexpr double kSwing = 2.5;
// Share of the time that threads with a cloth each must be busy for: about what several make of one.
constexpr double kBusy = 0.9;
constexpr std::int64_t kManyParticles = 8192;  // for whose contact threads stand by all frame

Simd resolve(Simd simd) {
  if (simd != Simd::best) return simd;
  for (Simd s : {Simd::avx512, Simd::avx2})
    if (simd_available(s)) return s;
  return Simd::sse2;
}

// Jacobi adds up corrections that each constraint works out for two ends of like mass; where a light
// particle has heavy neighbours they add up to more than the whole. And a single sweep with compliance
// is an explicit spring as stiff as the sweep allows, which large motions feed: two sweeps damp. Puts
// what is stable into the scene and returns what to tell, "" where nothing changed.
constexpr double kAlikeMasses = 4;  // greatest over least
std::string steady_jacobi(Scene& scene) {
  if (scene.solver.sweep != Sweep::jacobi) return "";
  const double dt = scene.time.substeps == kAutoSubsteps ? projection_substep(scene)
                                                         : scene.time.frame / scene.time.substeps;
  bool stiff = false;
  for (const Cloth& c : scene.cloths) {
    double lightest = particle_mass(c, 0, 0), heaviest = lightest;
    for (const double mass : c.masses) {
      lightest = std::min(lightest, mass);
      heaviest = std::max(heaviest, mass);
    }
    if (heaviest > kAlikeMasses * lightest) {
      scene.solver.sweep = Sweep::gauss_seidel;
      return "Jacobi sweeps do not converge for masses this unequal; gauss_seidel runs in their "
             "place";
    }
    const double k = std::max({c.stiffness.structural, c.stiffness.shear, c.stiffness.bend});
    stiff |= 2 * k * dt * dt > lightest;
  }
  if (!stiff || scene.solver.method != Method::compliant || scene.solver.iterations > 1) return "";
  scene.solver.iterations = 2;
  return "one Jacobi sweep of constraints this stiff is not stable in large motions; two run";
}

}  // namespace

Simulation::State::State(Scene given, const Options& given_options, const Vec3& about)
    : scene(std::move(given)),
      origin(about),
      options(given_options),
      simd(resolve(options.simd)),
      threads(options.threads),
      one_thread(1),
      method(scene.solver.method) {
  const std::string changed = steady_jacobi(scene);
  if (origin != Vec3{}) {
    placed = scene;
    scene = moved(std::move(scene), times(origin, -1));
  }
  build_cloths();
  choose_method_and_substeps();
  began_as_ = method;
  began_with_ = scene.solver;
  began_at_ = substeps;
  if (!changed.empty()) fall_back(changed);
  began_fallen_back_ = plan.fallback;
  began_notes_ = plan.notes;
  began_guard_ = guard_;
  frame_ms.reserve(std::size_t(std::clamp(scene.time.seconds / scene.time.frame, 1.0, 1e6)) + 1);
}

void Simulation::State::build_cloths() {
  cloths.clear();
  carried_.clear();
  backups_.clear();
  stage_ns.clear();
  apart_.reserve(scene.cloths.size());
  busy_.reserve(std::size_t(threads.count()));
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    cloths.push_back(
        std::make_unique<ClothStep>(scene, int(c), method, options.seed, kernel_table(simd)));
    const Lattice& l = cloths.back()->lattice();
    carried_.push_back(nullptr);
    backups_.push_back({Rows(l.rows, l.stride), Rows(l.rows, l.stride)});
    stage_ns.emplace_back(cloths.back()->stages().size());
    if (options.profile) cloths.back()->passes().profile(stage_ns.back());
  }
  self_collision = SelfContact::make(scene, cloths, kernel_table(simd));
  surface = self_collision
                ? SurfaceContact::make(scene, self_collision->sheets(), kernel_table(simd))
                : nullptr;
  untangle = self_collision ? std::make_unique<Untangle>(scene, cloths) : nullptr;
  rest = Rest::make(scene, cloths, kernel_table(simd));
}

// What is odd about how the cloths start, and what is done about it.
void Simulation::State::note_starts(std::vector<std::string>& notes) const {
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const std::string which = "cloth " + std::to_string(c);
    for (std::size_t k = 0; k < scene.colliders.size(); ++k) {
      const StartInside& start = cloths[c]->starts()[k];
      if (start.particles == 0 && start.triangles == 0) continue;
      const bool course = scene.colliders[k].friction.model == FrictionModel::course;
      const double deepest = std::max(start.deepest_particle, start.deepest_triangle);
      notes.push_back(
          which + " starts inside collider " + std::to_string(k) + ": " +
          std::to_string(start.particles) + " particles, " +
          (start.triangles > 0 ? std::to_string(start.triangles) + " triangles, " : "") + "up to " +
          number(deepest) + " m deep; " +
          (course ? "they are put out at once, as the course does"
                  : "moved out over " + std::to_string(kPulledFrames) + " frames"));
    }
    const Cloth& cloth = scene.cloths[c];
    const double spacing = std::min(spacing_u(cloth.grid), spacing_v(cloth.grid));
    if (cloth.self_collision.mode != SelfCollisionMode::off &&
        cloth.self_collision.thickness > spacing)
      notes.push_back(which + ": the thickness of " + number(cloth.self_collision.thickness) +
                      " m is above the spacing of " + number(spacing) +
                      " m; particles nearer than the thickness on the flat sheet do not meet");
    // Half the diagonal of a square is as far as a particle gets from all others.
    const double widest = 0.5 * std::hypot(spacing_u(cloth.grid), spacing_v(cloth.grid));
    if (cloth.self_collision.mode == SelfCollisionMode::particles && !surface &&
        cloth.self_collision.thickness < widest)
      notes.push_back(which + ": the thickness of " + number(cloth.self_collision.thickness) +
                      " m is below " + number(widest) +
                      " m, half the diagonal of a square: particles can pass between others (mode "
                      "surface lets nothing through)");
  }
  if (!self_collision) return;
  if (const SelfContact::Overlaps o = self_collision->overlaps(); o.pairs > 0)
    notes.push_back(std::to_string(o.pairs) +
                    " pairs of particles start nearer than the thickness, by up to " +
                    number(o.deepest) + " m; they are pushed apart");
  if (const std::size_t crossings = untangle->due() ? untangle->crossings() : 0; crossings > 0)
    notes.push_back(
        std::to_string(crossings) + " edges pass through triangles of cloth at the start; " +
        (surface ? "the smaller part of what meets is taken through, row by row"
                 : "their particles are kept apart on the sides where they are (mode surface takes "
                   "such sheets apart)"));
}

// What a cloth's particles are accelerated by as they lie, bodies that they touch included [m/s²].
void Simulation::State::accelerations_now(std::size_t cloth, std::vector<Vec3>& a) const {
  const ClothStep& step = *cloths[cloth];
  accelerations(scene, step.cloth(), step.families(), step.lattice(), step.bend_links(),
                method == Method::spring_friction, a);
  support(scene, double(frame) * scene.time.frame, dt, step.lattice(), a);
}

// v <- v - a lag: velocities of explicit springs are taken to where they lie behind the positions.
// `now` gives all velocities in double in place of v, so that what velocities() told comes back
// exactly.
void Simulation::State::stagger(const double* now) {
  std::vector<Vec3> a;
  for (std::size_t n = 0; n < cloths.size(); ++n) {
    Lattice& l = cloths[n]->lattice();
    accelerations_now(n, a);
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i)
        for (int c = 0; c < 3; ++c) {
          float& v = l.v.at(c, j, i);
          const double start = now && l.w(j, i) > 0 ? *now : v;
          v = float(start - a[std::size_t(j) * l.columns + i][c] * lag);
          if (now) ++now;
        }
  }
}

void Simulation::State::advance_frame() {
  if (!status.ok) return;
  const auto start = std::chrono::steady_clock::now();
  since_hand_ = grab_ || carried() ? 0 : std::min(since_hand_ + scene.time.frame, kCalm);
  if (hand_has_passed()) begin_again();
  for (std::size_t c = 0; c < cloths.size(); ++c)
    if (carried_[c]) wake(int(c));
  if (rest) rest->begin_frame(double(frame) * scene.time.frame);
  // What has been put in stays in when what did it is gone.
  if (was_driven_ && !driven()) open_guard();
  was_driven_ = driven();
  save();
  do {
    run_frame();
    look();
  } while (too_coarse());
  if (!finite_) {
    find_fault();
    restore();
    return;
  }
  calm();
  if (is_explicit(method) && !(rest && rest->all_asleep())) lag = dt / 2;
  for (auto& step : cloths)
    if (step->topology()) step->topology()->update();
  ++frame;
  total_substeps += substeps;

  if (rest) rest->end_frame([&](std::size_t c) -> const Rows& { return backups_[c].x; });
  if (is_explicit(method) && !(rest && rest->all_asleep())) follow_stretch(limit_);
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  total_ms += spent.count();
  // A run longer than the scene says keeps the times of its last frames.
  if (frame_ms.size() < frame_ms.capacity())
    frame_ms.push_back(float(spent.count()));
  else
    frame_ms[std::size_t(frame) % frame_ms.size()] = float(spent.count());
}

void Simulation::State::run_frame() {
  if (rest && rest->all_asleep()) return;
  if (!self_collision) return run_substeps(0, substeps);
  if (surface) begin_surfaces();
  if (self_collision->particles() < kManyParticles) return run_with_contact();
  threads.together([&] { run_with_contact(); });
}

// What the frame has come to.
void Simulation::State::look() {
  finite_ = true;
  for (std::size_t c = 0; c < cloths.size(); ++c)
    finite_ =
        finite_ && (asleep(c) || cloths[c]->lattice().x.greatest(kernel_table(simd)) < kFarAway);
  if (finite_ && !(rest && rest->all_asleep())) guard_.look(scene, cloths, driven());
}

void Simulation::State::run_with_contact() {
  for (int s = 0; s < substeps;) {
    const int count = std::min(until_collision_ - since_collision_, substeps - s);
    run_substeps(s, count);
    s += count;
    since_collision_ += count;
    // A frame ends with surfaces that have not crossed.
    if (since_collision_ < until_collision_ && !(surface && s == substeps)) break;
    const auto start = std::chrono::steady_clock::now();
    const double swing =
        is_explicit(method) ? kSwing * limit_ : std::numeric_limits<double>::infinity();
    until_collision_ = self_collision->run(dt, since_collision_, swing, threads);
    if (surface)
      until_collision_ = std::min(until_collision_, surface->run(dt, since_collision_, threads));
    since_collision_ = 0;
    const auto spent = std::chrono::steady_clock::now() - start;
    self_collision_ns += std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count();
    ++self_collision_runs;
  }
}

// Contact begins with what does not cross; what does comes apart first.
void Simulation::State::begin_surfaces() {
  if (untangle->due() || surface->forced()) {
    untangle->pull_apart();
    surface->leave_out(untangle->passing());
    surface->restart();
  }
  if (!surface->valid()) surface->begin(threads);
}

Substeps Simulation::State::substeps_from(int first, int count) const {
  const bool kicked = first == 0 && is_explicit(method);
  return {double(frame) * scene.time.frame + first * dt, dt, count, kicked ? lag + dt / 2 : dt};
}

// A thread each where that keeps all of them busy; else cloths that are worth all threads take them one
// after the other, and small ones run side by side.
void Simulation::State::run_substeps(int first, int count) {
  const Substeps now = substeps_from(first, count);
  const auto run = [&](std::size_t c, Threads& team) {
    cloths[c]->passes().run(now, team, rest ? rest->rows(c) : std::span<const RowSpan>());
  };
  const bool standing_by = threads.standing_by();
  const auto worth_running_apart = [&] {
    std::int64_t all = 0;
    for (const std::size_t c : apart_) all += particles(c);
    return apart_.size() > 1 && Passes::worth_running_apart(all, count, standing_by);
  };
  apart_.clear();
  for (std::size_t c = 0; c < cloths.size(); ++c)
    if (!asleep(c)) apart_.push_back(c);
  bool apart = worth_running_apart() && keep_busy(apart_);
  if (!apart) {
    std::size_t small = 0;
    for (const std::size_t c : apart_)
      if (cloths[c]->passes().worth_sharing(particles(c), count, standing_by))
        run(c, threads);
      else
        apart_[small++] = c;
    apart_.resize(small);
    apart = worth_running_apart();
  }
  const auto run_apart = [&] {
    threads.share(apart_.size(), !apart, [&](std::size_t n) { run(apart_[n], one_thread); });
  };
  apart ? threads.together(run_apart) : run_apart();
}

int Simulation::State::particles(std::size_t cloth) const {
  const Lattice& l = cloths[cloth]->lattice();
  return l.columns * l.rows;
}

// Whether cloths of such sizes, each going to the thread that is free first, keep threads busy for nearly
// all of the time.
bool Simulation::State::keep_busy(const std::vector<std::size_t>& each) {
  busy_.assign(std::size_t(threads.count()), 0);
  std::int64_t all = 0;
  for (const std::size_t c : each) {
    *std::min_element(busy_.begin(), busy_.end()) += particles(c);
    all += particles(c);
  }
  const std::int64_t longest = *std::max_element(busy_.begin(), busy_.end());
  return kBusy * double(longest) * threads.count() <= double(all);
}

void Simulation::State::set(std::span<const double> positions, const Vec3& from,
                            std::span<const double> velocities) {
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
  wake();
  const Vec3 off = minus(origin, from);
  for (auto& step : cloths) {
    Lattice& l = step->lattice();
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i, ++p)
        for (int c = 0; c < 3; ++c) {
          l.x.at(c, j, i) = float(positions[3 * p + c] - off[c]);
          l.v.at(c, j, i) = l.w(j, i) > 0 ? float(velocities[3 * p + c]) : 0;
        }
  }
  restart_stages();
  if (untangle) untangle->look();
  if (is_explicit(method)) {
    stagger(velocities.data());
    follow_stretch(stretched_limit());
  }
  open_guard();
  ++changes;
}

// Positions or velocities are others than the stages left.
void Simulation::State::restart_stages() {
  for (auto& step : cloths)
    for (const auto& stage : step->stages()) stage->restart();
  if (self_collision) self_collision->restart();
  if (surface) surface->restart();
  since_collision_ = 0;
  until_collision_ = 1;
}

// Somebody changed a cloth, or all of them.
void Simulation::State::wake(int cloth) {
  for (std::size_t c = 0; rest && c < cloths.size(); ++c)
    if (cloth < 0 || std::size_t(cloth) == c) rest->wake(int(c));
}

void Simulation::State::save() {
  saved_substeps_ = substeps;
  saved_lag_ = lag;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (asleep(c)) continue;
    backups_[c].x.copy(cloths[c]->lattice().x);
    backups_[c].v.copy(cloths[c]->lattice().v);
    if (Topology* topology = cloths[c]->topology()) topology->remember();
  }
}

void Simulation::State::restore() {
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (asleep(c)) continue;
    cloths[c]->lattice().x.copy(backups_[c].x);
    cloths[c]->lattice().v.copy(backups_[c].v);
    if (Topology* topology = cloths[c]->topology()) topology->go_back();
  }
  take_substeps(saved_substeps_);
  lag = saved_lag_;
}

std::size_t Simulation::State::backup_bytes() const {
  std::size_t bytes = 0;
  for (const Backup& b : backups_) bytes += b.x.bytes() + b.v.bytes();
  return bytes;
}

// Runs the frame again, stage by stage, to the first that leaves a particle non-finite.
void Simulation::State::find_fault() {
  restore();
  status.ok = false;
  status.frame = frame + 1;
  status.stage = "step";
  const Substeps all = substeps_from(0, substeps);
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    Lattice& l = cloths[c]->lattice();
    for (int s = 0; s < substeps; ++s) {
      const Substep substep = all.at(s);
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
