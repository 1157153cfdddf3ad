// What a simulation holds: how it is built from a scene, set from outside, saved and put back.
#include "physics/frame/state.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/contact/collider_stage.h"
#include "physics/contact/contact_reaction.h"
#include "physics/contact/moving_collider.h"
#include "physics/contact/start_inside.h"
#include "physics/model/clamp_to_int.h"
#include "physics/model/lattice/cuts.h"
#include "physics/model/lattice/stability.h"
#include "physics/model/path.h"
#include "weft/mesh.h"

namespace weft {

using namespace physics;

namespace {

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
    const double lightest = lightest_mass(c);
    double heaviest = lightest;
    for (const double mass : c.masses) heaviest = std::max(heaviest, mass);
    if (heaviest > kAlikeMasses * lightest) {
      scene.solver.sweep = Sweep::gauss_seidel;
      return "Jacobi sweeps do not converge for masses this unequal; gauss_seidel runs in their "
             "place";
    }
    stiff |= 2 * greatest_stiffness(c) * dt * dt > lightest;
  }
  if (!stiff || scene.solver.method != Method::compliant || scene.solver.iterations > 1) return "";
  scene.solver.iterations = 2;
  return "one Jacobi sweep of constraints this stiff is not stable in large motions; two run";
}

// Pins whose paths begin farther than `distance` from their places on the sheet, and the farthest [m].
struct FarPins {
  int count = 0;
  double most = 0;
};
FarPins far_pins(const Cloth& cloth, double distance) {
  FarPins far;
  const bool mesh = cloth.mesh.given();
  const std::vector<Vec3> vertices = mesh ? placed_vertices(cloth.mesh) : std::vector<Vec3>();
  for (const Pin& pin : cloth.pins) {
    if (!pin.moves()) continue;
    const Vec3 off = minus(pin_alone_at(cloth, pin, 0), mesh ? vertices[std::size_t(pin.i)]
                                                             : place_on(cloth.grid, pin.i, pin.j));
    const double length = std::sqrt(dot(off, off));
    if (length <= distance) continue;
    ++far.count;
    far.most = std::max(far.most, length);
  }
  return far;
}

// How far neighbours are apart, about [m].
double spacing_of(const Cloth& cloth) {
  return cloth.mesh.given() ? mean_edge(cloth.mesh)
                            : std::min(spacing_u(cloth.grid), spacing_v(cloth.grid));
}

// `surfaces`: whether any cloth meets others by its surface.
void note_thickness(const std::string& which, const Cloth& cloth, bool surfaces,
                    std::vector<std::string>& notes) {
  const SelfCollision& self = cloth.self_collision;
  if (self.mode == SelfCollisionMode::off) return;
  const bool mesh = cloth.mesh.given();
  const double spacing = spacing_of(cloth);
  const std::string thickness = which + ": the thickness of " + number(self.thickness) + " m is ";
  if (self.thickness > spacing)
    notes.push_back(thickness + "above the " + (mesh ? "mean edge of " : "spacing of ") +
                    number(spacing) + " m; particles nearer than the thickness on the " +
                    (mesh ? "mesh at rest" : "flat sheet") + " do not meet");
  // As far as a particle gets from all others, at least.
  const double widest = 0.5 * longest_edge(cloth);
  if (self.mode == SelfCollisionMode::particles && !surfaces && self.thickness < widest)
    notes.push_back(thickness + "below " + number(widest) + " m, half " +
                    (mesh ? "the longest edge" : "the diagonal of a square") +
                    ": particles can pass between others (mode surface lets nothing through)");
}

bool holds_several(const Scene& scene) {
  return std::any_of(scene.cloths.begin(), scene.cloths.end(), [](const Cloth& c) {
    return std::any_of(c.pins.begin(), c.pins.end(), [](const Pin& p) { return p.of_several(); });
  });
}

// Whether a cut of the scene passes between two neighbours.
bool crosses_sheet(const CutLine& cut, const Grid& grid) {
  bool crosses = false;
  for (const auto& [di, dj] : {std::pair(1, 0), {0, 1}})
    for_each_cut({cut}, grid, di, dj, [&](int, int, double) { crosses = true; });
  return crosses;
}

}  // namespace

Simulation::State::State(Scene given, const Options& given_options, const Vec3& about,
                         MakeModel make)
    : scene(std::move(given)),
      origin(about),
      options(given_options),
      simd(resolve(options.simd)),
      threads(options.threads),
      one_thread(1),
      method(scene.solver.method),
      make_model_(make) {
  const std::string changed = steady_jacobi(scene);
  if (origin != Vec3{} || holds_several(scene)) placed = scene;
  for (Cloth& cloth : scene.cloths) cloth.pins = single_pins(cloth);
  if (origin != Vec3{}) scene = moved(std::move(scene), times(origin, -1));
  build_cloths();
  for (const auto& cloth : cloths)
    cut_from_start.push_back(cloth->cloth().cuts.empty() ? std::vector<Joined>{}
                                                         : cloth->model().tearing()->torn_list());
  choose_method_and_substeps();
  if (threads.count() < threads.asked())
    plan.notes.push_back("the system starts no more than " + std::to_string(threads.count()) +
                         " of " + std::to_string(threads.asked()) +
                         " threads (a limit on processes or memory); the result is the same");
  if (!changed.empty()) fall_back(changed);
  began_ = {method, scene.solver, substeps, plan.fallback, plan.notes, guard_.energy()};
  frame_ms.reserve(std::size_t(clamp_to_int(scene.time.seconds / scene.time.frame, 1, 1000000)) +
                   1);
}

void Simulation::State::build_cloths() {
  cloths.clear();
  carried_.clear();
  records_.clear();
  asleep_.assign(scene.cloths.size(), 0);
  stage_ns.clear();
  apart_.reserve(scene.cloths.size());
  overlong_.resize(scene.cloths.size());
  busy_.reserve(std::size_t(threads.count()));
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    cloths.push_back(std::make_unique<ClothStep>(scene, int(c), method, options.seed,
                                                 kernel_table(simd), make_model_));
    carried_.push_back(nullptr);
    records_.emplace_back(cloths.back()->particles(), EnergyGuard::counted_gravity(scene),
                          kernel_table(simd));
    stage_ns.emplace_back(cloths.back()->stages().size());
    if (options.profile) cloths.back()->schedule().profile(stage_ns.back());
  }
  make_self_contact();
  sleeping = Sleeping::make(scene, cloths, kernel_table(simd));
}

// Contact that remembers nothing.
void Simulation::State::make_self_contact() {
  const std::vector<ClothModel*> models = models_of(cloths);
  self_collision = SelfContact::make(scene, models, kernel_table(simd));
  untangle = self_collision ? std::make_unique<Untangle>(scene, models) : nullptr;
}

// The stages that run, and those that do not, with the reason.
Plan Simulation::State::describe_stages() const {
  Plan all = describe(cloths);
  const auto choose = [&](bool runs, const PlannedStage& stage, const char* why_not) {
    if (runs)
      all.stages.push_back(stage);
    else
      all.skipped.push_back({stage.name, why_not});
  };
  const std::int64_t meeting = self_collision ? std::int64_t(self_collision->particles()) : 0;
  const bool surfaces = self_collision && self_collision->surfaces();
  choose(self_collision != nullptr,
         {"self_collision", "all cloths together, as often as they move", 0, meeting, "particles"},
         "off in the scene");
  choose(surfaces,
         {"self_surface", "vertices against triangles, edges against edges; nothing passes through",
          0, meeting, "squares"},
         self_collision ? "self_collision is particles in all cloths" : "off in the scene");
  if (!sleeping)
    all.skipped.push_back({"sleep", scene.solver.sleep > 0
                                        ? "gusts or changing gravity move the cloth"
                                        : "sleep is 0"});
  return all;
}

// What is odd about how the cloths start, and what is done about it.
void Simulation::State::note_starts(std::vector<std::string>& notes) const {
  if (!scene.gravity_keys.empty())
    notes.push_back("gravity follows its keys from " + number(scene.gravity_keys.front().time) +
                    " to " + number(scene.gravity_keys.back().time) + " s");
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
    note_thickness(which, cloth, self_collision && self_collision->surfaces(), notes);
    if (const FarPins far = far_pins(cloth, spacing_of(cloth)); far.count > 0)
      notes.push_back(which + ": " + std::to_string(far.count) +
                      (far.count == 1 ? " pin starts " : " pins start up to ") + number(far.most) +
                      " m from where the sheet has " + (far.count == 1 ? "it" : "them") +
                      " (a pin with keys begins where they say); the sheet is stretched there");
    for (std::size_t k = 0; k < cloth.cuts.size(); ++k)
      if (!crosses_sheet(cloth.cuts[k], cloth.grid))
        notes.push_back(which + ": cut " + std::to_string(k) + " passes between no two particles");
  }
  if (!self_collision) return;
  if (const SelfContact::Overlaps o = self_collision->overlaps(); o.pairs > 0)
    notes.push_back(std::to_string(o.pairs) +
                    " pairs of particles start nearer than the thickness, by up to " +
                    number(o.deepest) + " m; they are pushed apart");
  if (const std::size_t crossings = untangle->due() ? untangle->crossings() : 0; crossings > 0)
    notes.push_back(
        std::to_string(crossings) + " edges pass through triangles of cloth at the start; " +
        (self_collision->surfaces()
             ? "the smaller part of what meets is taken through, row by row"
             : "their particles are kept apart on the sides where they are (mode surface takes "
               "such sheets apart)"));
}

// What a cloth's particles are accelerated by as they lie, bodies that they touch included [m/s²].
// Velocities lie so far behind the positions [s].
void Simulation::State::accelerations_now(std::size_t cloth, double behind,
                                          std::vector<Vec3>& a) const {
  const ClothStep& step = *cloths[cloth];
  const double time = double(frame) * scene.time.frame;
  step.model().accelerations(gravity_at(scene, time), a);
  if (const Load* load = step.model().load()) load->add_accelerations(time, a);
  support(scene, step.cloth(), time, {dt, behind}, step.particles(), a);
}

// v <- v - a by: velocities of explicit springs are taken to where they lie behind the positions. `from`
// gives all velocities in double in place of v, so that what velocities() told comes back exactly.
void Simulation::State::stagger(double by, const double* from) {
  std::vector<Vec3> a;
  for (std::size_t n = 0; n < cloths.size(); ++n) {
    Particles& p = cloths[n]->particles();
    accelerations_now(n, 0, a);
    p.for_each([&](int j, int i) {
      for (int c = 0; c < 3; ++c) {
        float& v = p.v.at(c, j, i);
        const double start = from && p.w(j, i) > 0 ? *from : v;
        v = float(start - a[std::size_t(p.number(j, i))][c] * by);
        if (from) ++from;
      }
    });
  }
}

void Simulation::State::set(std::span<const double> positions, const Vec3& from,
                            std::span<const double> velocities, std::optional<double> behind) {
  std::size_t particles = 0;
  for (const auto& step : cloths) particles += std::size_t(step->particles().count());
  if (positions.size() != 3 * particles || velocities.size() != 3 * particles)
    throw std::invalid_argument("a state needs " + std::to_string(3 * particles) +
                                " positions and as many velocities");
  const auto bad = [](double v) { return !(std::abs(v) <= std::numeric_limits<float>::max()); };
  if (std::any_of(positions.begin(), positions.end(), bad) ||
      std::any_of(velocities.begin(), velocities.end(), bad))
    throw std::invalid_argument("a state holds a value that is not finite");
  const Vec3 off = minus(origin, from);
  for (std::size_t n = 0; n < positions.size(); ++n)
    if (!(std::abs(positions[n] - off[n % 3]) < kFarAway))
      throw std::invalid_argument("a state holds a position more than 1e7 m away");
  std::size_t p = 0;
  bool as_told = !behind;
  wake();
  for (auto& step : cloths) {
    Particles& l = step->particles();
    l.for_each([&](int j, int i) {
      for (int c = 0; c < 3; ++c, ++p) {
        l.x.at(c, j, i) = coordinate(positions[p] - off[c]);
        float& v = l.v.at(c, j, i);
        as_told &= v == float(velocities[p]);
        v = l.w(j, i) > 0 ? float(velocities[p]) : 0;
      }
    });
  }
  for (Carry* carry : carried_)
    if (carry) carry->begin_anew(double(frame) * scene.time.frame);
  restart_stages();
  if (untangle) untangle->look();
  if (is_explicit(method)) {
    stagger(lag - behind.value_or(0), velocities.data());
    limit_ = stretched_limit();
    follow_stretch(limit_);
  } else if (scene.solver.order == 1 && !as_told) {
    lag = behind.value_or(0);
  }
  open_guard();
  ++changes;
}

// Positions or velocities are others than the stages left.
void Simulation::State::restart_stages() {
  for (auto& step : cloths) step->restart();
  if (self_collision) self_collision->restart();
  until_collision_ = 1;
}

// Somebody changed a cloth, or all of them.
void Simulation::State::wake(int cloth) {
  for (std::size_t c = 0; sleeping && c < cloths.size(); ++c)
    if (cloth < 0 || std::size_t(cloth) == c) sleeping->wake(int(c));
}

// The passes keep rows as they come to them, unless contact moves them before.
void Simulation::State::save() {
  saved_substeps_ = substeps;
  saved_lag_ = lag;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (asleep(c)) continue;
    if (self_collision) records_[c].keep();
    if (Tearing* tearing = cloths[c]->model().tearing()) tearing->remember();
  }
}

void Simulation::State::restore() {
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (asleep(c)) continue;
    records_[c].restore();
    if (Tearing* tearing = cloths[c]->model().tearing()) tearing->go_back();
  }
  if (self_collision) self_collision->go_back();
  take_substeps(saved_substeps_);
  lag = saved_lag_;
}

std::size_t Simulation::State::record_bytes() const {
  std::size_t bytes = 0;
  for (const RollbackBuffer& r : records_) bytes += r.bytes();
  return bytes;
}

}  // namespace weft
