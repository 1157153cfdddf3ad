// The passes over a cloth's stages (passes.h).
#include "physics/passes.h"

#include <chrono>

#include "physics/threads.h"

namespace weft::physics {
namespace {

// Rough cost of a row, for sizing tasks only: nanoseconds per constraint and per particle.
constexpr double kConstraintNs = 0.5, kParticleNs = 0.5;

// Particles times substeps, and particles, from which several threads are faster than one.
constexpr double kSharedRun = 150000;
constexpr int kSharedSubstep = 15000;

double row_nanoseconds(const std::vector<RowStage*>& stages, int rows) {
  double ns = 0;
  for (const RowStage* s : stages)
    ns += double(s->items) * (s->item == "constraints" ? kConstraintNs : kParticleNs);
  return ns / rows;
}

}  // namespace

Passes::Passes(const Stages& stages, int rows, std::size_t row_bytes) {
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
    if (auto* row_stage = dynamic_cast<RowStage*>(stages[q].get())) {
      together.push_back(row_stage);
      continue;
    }
    close(q);
    passes_.push_back({q, dynamic_cast<WholeStage*>(stages[q].get()), nullptr, 1});
    ++whole_stages_;
  }
  close(stages.size());
}

// Threads meet at the end of the frame, or in every substep.
bool Passes::worth_sharing(int particles, int substeps) const {
  return rows_only() ? double(particles) * substeps >= kSharedRun : particles >= kSharedSubstep;
}

void Passes::run(const Substeps& substeps, Threads& threads, std::span<const RowSpan> awake) {
  if (rows_only()) {
    threads.together([&] {
      for (Pass& p : passes_) p.wavefront->run(substeps, threads, awake);
    });
    return;
  }
  for (Pass& p : passes_)
    if (p.whole && substeps.dt != prepared_dt_) p.whole->prepare(substeps.dt);
  prepared_dt_ = substeps.dt;
  threads.together([&] {
    for (int s = 0; s < substeps.count; ++s) run_substep(substeps, s, threads, awake);
  });
}

void Passes::run_substep(const Substeps& substeps, int s, Threads& threads,
                         std::span<const RowSpan> awake) {
  const Substep substep = substeps.at(s);
  for (Pass& p : passes_) {
    if (p.wavefront) {
      p.wavefront->run({substeps.time + s * substeps.dt, substeps.dt, 1, substep.kick}, threads,
                       awake);
      continue;
    }
    const auto before = std::chrono::steady_clock::now();
    p.whole->run(substep, threads);
    if (profile_.empty()) continue;
    const auto spent = std::chrono::steady_clock::now() - before;
    profile_[p.first] += std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count();
  }
}

void Passes::profile(std::span<std::atomic<std::int64_t>> nanoseconds) {
  profile_ = nanoseconds;
  for (Pass& p : passes_)
    if (p.wavefront) p.wavefront->profile(nanoseconds.subspan(p.first, p.count));
}

}  // namespace weft::physics
