// How a simulation is built from a scene, set from outside, saved and put back (state.h).
#include "physics/frame/state.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/frame/driven.h"
#include "physics/frame/projection_substep.h"
#include "physics/frame/velocities.h"
#include "physics/model/clamp_to_int.h"
#include "weft/vec3.h"

namespace weft {

using namespace physics;

namespace {

// Frames that the scene's own length asks to keep times of, at most a million.
std::size_t frames_of(const Time& time) {
  return std::size_t(clamp_to_int(time.seconds / time.frame, 1, 1000000)) + 1;
}

}  // namespace

Simulation::State::State(Scene given, const Options& given_options, const Vec3& about,
                         MakeModel make)
    : placed(std::move(given), about),
      options(given_options),
      simd(resolved(options.simd)),
      runner(options.threads, scene.cloths.size()),
      time_step{.method = scene.solver.method, .spectra = {}},
      times(frames_of(scene.time)),
      make_model_(make),
      hands_(cloths, scene.cloths.size()),
      notes_(scene) {
  const std::string changed = placed.steady();
  build_cloths();
  for (const auto& cloth : cloths)
    cut_from_start.push_back(cloth->cloth().cuts.empty() ? std::vector<Joined>{}
                                                         : cloth->model().tearing()->torn_list());
  choose_method_and_substeps();
  const Threads& threads = runner.threads();
  if (threads.count() < threads.asked())
    plan.notes.push_back("the system starts no more than " + std::to_string(threads.count()) +
                         " of " + std::to_string(threads.asked()) +
                         " threads (a limit on processes or memory); the result is the same");
  if (!changed.empty()) fall_back("", changed);
  began_ = {time_step.method, scene.solver, time_step.substeps,
            plan.fallback,    plan.notes,   guard_.energy()};
}

void Simulation::State::build_cloths() {
  const KernelTable& kernels = kernel_table(simd);
  cloths.clear();
  for (std::size_t c = 0; c < scene.cloths.size(); ++c)
    cloths.push_back(std::make_unique<ClothStep>(scene, int(c), time_step.method, options.seed,
                                                 kernels, make_model_));
  start_.watch(cloths, EnergyGuard::counted_gravity(scene), kernels);
  times.follow(cloths, options.profile);
  contact = SheetContact::make(scene, cloths, kernels);
  sleeping = Sleeping::make(scene, cloths, kernels);
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
  const std::int64_t meeting = contact ? contact->pairs().particles() : 0;
  const PlannedStage sheets{"self_collision", "all cloths together, as often as they move", 0,
                            meeting, "particles"};
  if (contact && cloths.front()->sheets_meet_first())
    all.stages.insert(all.stages.begin() + std::ptrdiff_t(cloths.front()->motion_stages()), sheets);
  else
    choose(contact != nullptr, sheets, "off in the scene");
  choose(contact && contact->pairs().surfaces(),
         {"self_surface", "vertices against triangles, edges against edges; nothing passes through",
          0, meeting, "squares"},
         contact ? "self_collision is particles in all cloths" : "off in the scene");
  if (!sleeping)
    all.skipped.push_back({"sleep", scene.solver.sleep > 0
                                        ? "gusts or changing gravity move the cloth"
                                        : "sleep is 0"});
  return all;
}

// The stages of a cloth have changed: their times start anew, and the plan tells what runs now.
void Simulation::State::plan_changed() {
  times.follow(cloths, options.profile);
  Plan now = describe_stages();
  now.dt_limit = plan.dt_limit;
  now.notes = plan.notes;
  now.fallback = plan.fallback;
  plan = std::move(now);
  take_substeps(time_step.substeps);
}

namespace {

void check_state(std::span<const double> positions, const Vec3& off,
                 std::span<const double> velocities, std::size_t particles) {
  if (positions.size() != 3 * particles || velocities.size() != 3 * particles)
    throw std::invalid_argument("a state needs " + std::to_string(3 * particles) +
                                " positions and as many velocities");
  const auto bad = [](double v) { return !(std::abs(v) <= std::numeric_limits<float>::max()); };
  if (std::any_of(positions.begin(), positions.end(), bad) ||
      std::any_of(velocities.begin(), velocities.end(), bad))
    throw std::invalid_argument("a state holds a value that is not finite");
  for (std::size_t n = 0; n < positions.size(); ++n)
    if (!(std::abs(positions[n] - off[n % 3]) < kFarAway))
      throw std::invalid_argument("a state holds a position more than 1e7 m away");
}

}  // namespace

void Simulation::State::set(std::span<const double> positions, const Vec3& from,
                            std::span<const double> velocities, std::optional<double> behind) {
  const Vec3 off = minus(placed.origin(), from);
  std::size_t particles = 0;
  for (const auto& step : cloths) particles += std::size_t(step->particles().count());
  check_state(positions, off, velocities, particles);
  std::size_t n = 0;
  bool as_told = !behind;
  wake();
  for (auto& step : cloths) {
    Particles& p = step->particles();
    p.for_each([&](int j, int i) {
      for (int c = 0; c < 3; ++c, ++n) {
        p.x.at(c, j, i) = coordinate(positions[n] - off[c]);
        float& v = p.v.at(c, j, i);
        as_told &= v == float(velocities[n]);
        v = p.w(j, i) > 0 ? float(velocities[n]) : 0;
      }
    });
  }
  hands_.begin_anew(time());
  restart_stages();
  if (contact) contact->look();
  if (is_explicit(time_step.method)) {
    std::size_t first = 0;
    for (auto& step : cloths) {
      const std::size_t values = 3 * std::size_t(step->particles().count());
      stagger(*step, time(), time_step.dt, time_step.lag - behind.value_or(0),
              velocities.subspan(first, values));
      first += values;
    }
    time_step.limit = stretched_limit();
    follow_stretch(time_step.limit);
  } else if (scene.solver.order == 1 && !as_told) {
    time_step.lag = behind.value_or(0);
  }
  open_guard();
  ++changes;
}

std::vector<Vec3> Simulation::State::velocities(std::size_t cloth) const {
  return velocities_now(*cloths[cloth], time(), time_step);
}

// Positions or velocities are others than the stages left.
void Simulation::State::restart_stages() {
  for (auto& step : cloths) step->restart();
  if (contact) contact->restart();
}

// Somebody changed a cloth, or all of them.
void Simulation::State::wake(int cloth) {
  for (std::size_t c = 0; sleeping && c < cloths.size(); ++c)
    if (cloth < 0 || std::size_t(cloth) == c) sleeping->wake(int(c));
}

// What falls asleep takes its energy out of the sum, and brings it back.
bool Simulation::State::driven() const {
  return hands_.act() || contact || (sleeping && sleeping->asleep() > 0) ||
         is_driven(scene, cloths);
}

void Simulation::State::open_guard() {
  guard_.energy().open(scene, time_step.method, cloths, time(), time_step.dt, runner.threads());
  notes_.begin_anew(cloths, time(), time_step);
  hands_.tell(guard_.energy());
}

void Simulation::State::save() {
  start_.save(cloths, sleeping.get(), time_step, contact != nullptr);
  if (contact) contact->save();
}

void Simulation::State::put_back() {
  start_.restore(cloths, sleeping.get(), time_step, scene.time.frame);
  if (contact) contact->go_back();
  take_substeps(time_step.substeps);
}

std::size_t Simulation::State::bytes() const {
  std::size_t bytes = start_.bytes();
  for (const auto& step : cloths) bytes += step->bytes();
  return bytes + (sleeping ? sleeping->bytes() : 0);
}

}  // namespace weft
