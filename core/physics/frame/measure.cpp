// Measures a simulation (measure.h). Nothing here touches the state.
#include "physics/frame/measure.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "physics/contact/colliders/shapes.h"
#include "physics/contact/self/crossings.h"
#include "physics/contact/start_inside.h"
#include "physics/frame/energy_now.h"
#include "weft/shape.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

void add_energy(const Simulation::State& s, std::size_t index, Report& r) {
  const ClothStep& step = *s.cloths[index];
  const Particles& particles = step.particles();
  const std::span<const float> masses = s.masses(index).span();
  const std::vector<Vec3> x = particles.gather(particles.x);
  const std::vector<Vec3> v = measured_velocities(step, s.time(), s.time_step);
  const EnergyNow energy = energy_now(step, masses, v, s.time(), s.placed.origin());
  r.energy.kinetic += energy.kinetic;
  r.energy.gravity += energy.gravity;
  r.energy.elastic += energy.elastic.sum() + energy.load;
  r.membrane_energy += energy.elastic.membrane;
  r.bending_energy += energy.elastic.bending;
  for (std::size_t p = 0; p < x.size(); ++p) {
    if (masses[particles.lane(int(p))] == 0) continue;
    const double m = step.model().mass(int(p));
    const Vec3 a = plus(x[p], s.placed.origin());
    const Vec3& b = v[p];
    for (int k = 0; k < 3; ++k) {
      r.momentum[k] += m * b[k];
      const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      r.angular_momentum[k] += m * (a[k1] * b[k2] - a[k2] * b[k1]);
    }
  }
}

void add_constraints(const ClothStep& step, Report& r) {
  const ConstraintCounts counts = step.model().constraints();
  r.constraints.structural += counts.structural;
  r.constraints.shear += counts.shear;
  r.constraints.bend += counts.bend;
}

void add_penetration(const Simulation::State& s, const ClothStep& step, Report& r) {
  const double time = s.time();
  const std::vector<Vec3> x = step.particles().gather(step.particles().x);
  for (const Collider& c : s.scene.colliders)
    if (!c.cuts)
      r.penetration.collider_max =
          std::max(r.penetration.collider_max,
                   deepest_in(step.cloth(), c, time, x, step.model().surface().triangles));
}

void add_self_contact(const Simulation::State& s, Report& r) {
  std::vector<Vec3> x;
  std::vector<Face> faces;
  std::vector<std::int32_t> sewn;
  for (const ClothModel* model : models_of(s.cloths)) {
    add_surface(*model, x, faces);
    add_sewn(*model, sewn);
  }
  r.penetration.crossings = count_crossings(x, faces, sewn);
  if (!s.contact) return;
  // By a search of its own: the one that runs must not notice.
  const SelfContact::Overlaps overlaps =
      SelfContact::make(s.scene, models_of(s.cloths), kernel_table(s.simd))->overlaps();
  const SelfContact::Record& record = s.contact->pairs().record();
  r.contact = {record.contacts_now, record.energy_taken, record.greatest_held,
               record.least_distance};
  r.penetration.self_pairs = overlaps.pairs;
  r.penetration.self_max = overlaps.deepest;
}

// What the stages passed over while they ran.
void add_idle(const Simulation::State& s, Report& r) {
  for (const auto& step : s.cloths)
    for (const auto& stage : step->stages())
      if (const double idle = stage->idle(); idle > 0) {
        char why[64];
        std::snprintf(why, sizeof why, "%.1f %% of the rows were out of reach", 100 * idle);
        r.skipped.push_back({stage->name, stage->detail + ": " + why});
      }
  if (s.sleeping) {
    char why[96];
    std::snprintf(why, sizeof why,
                  "%lld particles are asleep; %.1f %% of all rows' frames were slept through",
                  static_cast<long long>(s.sleeping->asleep()), 100 * s.sleeping->share());
    r.skipped.push_back({"sleep", why});
  }
  if (s.contact && s.contact->runs() > 0) {
    const auto percent_of_substeps = [&](std::int64_t times) {
      return 100 * double(times) / double(std::max<std::int64_t>(s.total_substeps, 1));
    };
    const SelfContact::Record& of = s.contact->pairs().record();
    const double runs = double(std::max<std::int64_t>(of.runs, 1));
    char why[240];
    std::snprintf(why, sizeof why,
                  "ran after %.1f %% of the substeps, searched in %.1f %% of those; %.1f %% of the "
                  "particles had nothing near; %.1f contacts, swept %.1f times",
                  percent_of_substeps(s.contact->runs()), 100 * double(of.searches) / runs,
                  100 * of.passed_over / (runs * double(s.contact->pairs().particles())),
                  double(of.contacts) / runs, double(of.sweeps) / runs);
    r.skipped.push_back({"self_collision", why});
    if (s.contact->pairs().surfaces()) {
      std::snprintf(why, sizeof why, "%lld moves of particles cut short",
                    static_cast<long long>(of.held));
      r.skipped.push_back({"self_surface", why});
    }
  }
}

void add_wall_time(const Simulation::State& s, Report& r) {
  std::vector<float> ms = s.times.frames();
  std::sort(ms.begin(), ms.end());
  r.wall_ms.total = s.times.total();
  if (ms.empty()) return;
  const auto quantile = [&](double q) {
    return double(ms[std::size_t(q * double(ms.size() - 1))]);
  };
  r.wall_ms.frame_min = ms.front();
  r.wall_ms.frame_median = quantile(0.5);
  r.wall_ms.frame_p99 = quantile(0.99);
  r.wall_ms.frame_max = ms.back();
}

// Stages of one name together, plus what the frame spends outside them; sums to the total.
void add_stages(const Simulation::State& s, Report& r) {
  if (!s.options.profile) {
    r.stages.push_back({"step", s.times.total(), s.total_substeps});
    return;
  }
  double sum = 0;
  for (std::size_t c = 0; c < s.cloths.size(); ++c) {
    const auto& stages = s.cloths[c]->stages();
    for (std::size_t q = 0; q < stages.size(); ++q) {
      const double ms = s.times.stage(c, q);
      auto at = std::find_if(r.stages.begin(), r.stages.end(),
                             [&](const StageTime& t) { return t.name == stages[q]->name; });
      if (at == r.stages.end()) at = r.stages.insert(at, {stages[q]->name, 0, 0});
      at->ms += ms;
      at->calls += s.total_substeps;
      sum += ms;
    }
  }
  if (s.contact) {
    const double ms = s.contact->milliseconds();
    r.stages.push_back({"self_collision", ms, s.contact->runs()});
    sum += ms;
  }
  // Several threads spend more than passes on the clock: shares of the work, not of the wall.
  const double scale = sum > s.times.total() ? s.times.total() / sum : 1;
  for (StageTime& t : r.stages) t.ms *= scale;
  r.stages.push_back({"frame", std::max(0.0, s.times.total() - sum * scale), s.frame});
}

}  // namespace

Strain strain_of(const Cloths& cloths) {
  Strain all{0, 0, 0};
  for (const auto& step : cloths) {
    const Strain strain = step->model().strain();
    if (strain.constraints == 0) continue;
    all.max = all.constraints > 0 ? std::max(all.max, strain.max) : strain.max;
    all.mean += strain.mean * double(strain.constraints);
    all.constraints += strain.constraints;
  }
  if (all.constraints > 0) all.mean /= double(all.constraints);
  return all;
}

std::uint64_t state_hash(const Simulation::State& s) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  const auto add = [&](float value) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    for (int b = 0; b < 4; ++b) hash = (hash ^ (bits >> (8 * b) & 0xff)) * 0x100000001b3u;
  };
  for (const auto& step : s.cloths) {
    const Particles& p = step->particles();
    p.for_each([&](int j, int i) {
      for (int k = 0; k < 3; ++k) add(p.x.at(k, j, i));
    });
  }
  return hash;
}

Report measure(const Simulation::State& s, bool contacts) {
  Report r;
  r.scene = s.scene.name;
  r.version = WEFT_VERSION;
#if defined(__clang__)
  r.compiler = "clang++ " __clang_version__;
#else
  r.compiler = "g++ " __VERSION__;
#endif
  r.simd = simd_name(s.simd);
  r.frames = s.frame;
  r.substeps = s.total_substeps;
  r.dt = s.time_step.dt;
  r.sim_seconds = s.time();
  r.threads = s.runner.threads().count();
  r.skipped = s.plan.skipped;
  r.notes = s.plan.notes;
  r.status = s.status;
  r.finite = s.status.ok;
  for (std::size_t c = 0; c < s.cloths.size(); ++c) {
    const ClothStep& step = *s.cloths[c];
    r.particles += step.particles().count();
    add_constraints(step, r);
    add_energy(s, c, r);
    if (const Tearing* tearing = step.model().tearing()) r.torn += tearing->torn();
    if (contacts) add_penetration(s, step, r);
  }
  r.energy.total = r.energy.kinetic + r.energy.elastic + r.energy.gravity;
  const Strain strain = strain_of(s.cloths);
  r.strain = {strain.max, strain.mean, s.greatest_strain};
  if (s.options.follow_strain && s.frame == 0) r.strain.max_of_frames = strain.max;
  if (contacts && s.status.ok) add_self_contact(s, r);
  if (s.sleeping) r.asleep = s.sleeping->asleep();
  add_idle(s, r);
  add_wall_time(s, r);
  add_stages(s, r);
  r.hash = state_hash(s);
  return r;
}

}  // namespace weft::physics
