// The frame: substeps of all cloths, contact between them, the verdict on what came of it, and a stop with the
// place of the fault when the state turns non-finite.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "physics/frame/driven.h"
#include "physics/frame/measure.h"
#include "physics/frame/state.h"

namespace weft {

using namespace physics;

void Simulation::State::advance_frame() {
  if (!status.ok) return;
  const auto start = std::chrono::steady_clock::now();
  hands_.act() ? guard_.interacted() : guard_.pass(scene.time.frame);
  if (guard_.interaction_has_passed(scene, cloths, driven(), began_.energy)) begin_again();
  for (std::size_t c = 0; c < cloths.size(); ++c)
    if (hands_.carries(c)) wake(int(c));
  if (sleeping) sleeping->begin_frame(time());
  // What has been put in stays in when what did it is gone.
  if (was_driven_ && !driven()) open_guard();
  was_driven_ = driven();
  save();
  Verdict verdict;
  do {
    run_frame();
    verdict = guard_.judge(frame_run());
  } while (carry_out(verdict));
  if (verdict == Verdict::stop) {
    find_fault();
    put_back();
    return;
  }
  end_frame();
  times.add_frame(frame, std::chrono::steady_clock::now() - start);
}

void Simulation::State::run_frame() {
  if (all_asleep()) return;
  const auto run = [&](int first, int count, Schedule::Part part) {
    runner.run(cloths, time_step.substeps_from(time(), first, count), sleeping.get(),
               contact ? std::span<RollbackBuffer>() : start_.rows(), part);
  };
  if (!contact) return run(0, time_step.substeps, Schedule::Part::whole);
  contact->run_frame(time_step.substeps_from(time(), 0, time_step.substeps), runner.threads(), run);
}

// What the frame has come to.
FrameRun Simulation::State::frame_run() {
  FrameRun run{.scene = scene,
               .method = time_step.method,
               .cloths = cloths,
               .threads = runner.threads(),
               .starts = start_.rows(),
               .sleeping = sleeping.get(),
               .frame = frame,
               .dt = time_step.dt,
               .finite = true,
               .energy = {},
               .limit = time_step.limit,
               .driven = was_driven_,
               .alone = !hands_.act() && !contact && !is_acted_on(scene, cloths)};
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (is_asleep(run.sleeping, c)) continue;
    RollbackBuffer& rows = start_.rows()[c];
    if (contact) rows.measure();  // else its schedule has looked
    run.energy += rows.energy_sum();
  }
  run.finite = run.energy.greatest < kFarAway;
  if (run.finite && is_explicit(run.method) && !all_asleep())
    run.limit = time_step.limit = stretched_limit();
  return run;
}

// The frame stands.
void Simulation::State::end_frame() {
  if (!all_asleep()) {
    guard_.energy().accept(time_step.substeps);
    time_step.lag = time_step.lag_between_substeps(scene.solver.order);
  }
  for (auto& step : cloths)
    if (Tearing* tearing = step->model().tearing()) tearing->update();
  ++frame;
  total_substeps += time_step.substeps;
  notes_.look(
      {frame, time(), time_step, cloths, runner.threads(), sleeping.get(), contact.get(),
       guard_.energy(), hands_.act() || is_driven(scene, cloths)},
      plan.notes);
  if (options.follow_strain)
    greatest_strain = std::max(greatest_strain.value_or(-1), strain_of(cloths).max);
  if (sleeping)
    sleeping->end_frame([&](std::size_t c) -> const Rows& { return start_.rows()[c].x(); });
  const bool longer = guard_.limits().accept();
  if (is_explicit(time_step.method) && !all_asleep()) {
    follow_stretch(time_step.limit);
  } else if (longer) {
    take_substeps(projection_substeps(scene) * guard_.finer());
  }
}

namespace {

// The first particle that is not finite, or too far away; none where all are well.
std::optional<int> first_at_fault(const Particles& p) {
  for (int n = 0; n < p.count(); ++n) {
    const auto [j, i] = p.place(n);
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(p.x.at(k, j, i)) < kFarAway) || !std::isfinite(p.v.at(k, j, i))) return n;
  }
  return std::nullopt;
}

// A particle as messages name it: [column, row] in a grid.
std::string name_of(const Cloth& cloth, int particle) {
  if (cloth.mesh.given()) return "particle " + std::to_string(particle);
  return "particle [" + std::to_string(particle % cloth.grid.nx) + "," +
         std::to_string(particle / cloth.grid.nx) + "]";
}

}  // namespace

// Runs the frame again, stage by stage, to the first that leaves a particle non-finite.
void Simulation::State::find_fault() {
  put_back();
  status.ok = false;
  status.frame = frame + 1;
  const std::string where = "not finite in frame " + std::to_string(status.frame);
  const Substeps all = time_step.substeps_from(time(), 0, time_step.substeps);
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const Particles& p = cloths[c]->particles();
    for (int s = 0; s < all.count; ++s)
      for (const auto& stage : cloths[c]->stages()) {
        stage->run_alone(p.rows, all.at(s), runner.threads());
        const std::optional<int> fault = first_at_fault(p);
        if (!fault) continue;
        status.stage = stage->name;
        status.cloth = int(c);
        status.particle = *fault;
        status.text = where + ", substep " + std::to_string(s + 1) + ", stage " + stage->name +
                      ", cloth " + std::to_string(c) + ", " + name_of(cloths[c]->cloth(), *fault);
        return;
      }
  }
  // Every stage stays finite by itself: what runs between them does not.
  status.stage = contact ? "self_collision" : "step";
  status.text = where + ", stage " + status.stage;
}

}  // namespace weft
