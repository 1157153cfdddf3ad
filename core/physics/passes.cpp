// The passes over a cloth's stages (passes.h).
#include "physics/passes.h"

#include <chrono>

namespace weft::physics {
namespace {

// Rough cost of a row, for sizing tasks only: nanoseconds per constraint and per particle.
constexpr double kConstraintNs = 0.5, kParticleNs = 0.5;

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

void Passes::run(double time, double dt, int count, Threads& threads,
                 std::span<const RowSpan> awake) {
  if (rows_only()) {
    for (Pass& p : passes_) p.wavefront->run(time, dt, count, threads, awake);
    return;
  }
  for (Pass& p : passes_)
    if (p.whole && dt != prepared_dt_) p.whole->prepare(dt);
  prepared_dt_ = dt;
  for (int s = 0; s < count; ++s) {
    const Substep substep{dt, time + (s + 1) * dt, 0};
    for (Pass& p : passes_) {
      if (p.wavefront) {
        p.wavefront->run(time + s * dt, dt, 1, threads, awake);
        continue;
      }
      const auto before = std::chrono::steady_clock::now();
      p.whole->run(substep, threads);
      if (profile_.empty()) continue;
      const auto spent = std::chrono::steady_clock::now() - before;
      profile_[p.first] += std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count();
    }
  }
}

void Passes::profile(std::span<std::atomic<std::int64_t>> nanoseconds) {
  profile_ = nanoseconds;
  for (Pass& p : passes_)
    if (p.wavefront) p.wavefront->profile(nanoseconds.subspan(p.first, p.count));
}

}  // namespace weft::physics
