// What rounding leaves (remainders.h).
#include "physics/model/remainders.h"

#include <algorithm>

#include "physics/step/keeper.h"

namespace weft::physics {
namespace {

void make_room(Remainders& left, const Particles& particles) {
  if (left.bytes() > 0) return;
  left.x = Rows(particles.rows, particles.stride);
  left.v = Rows(particles.rows, particles.stride);
}

}  // namespace

double forces_keep_below(const ClothParts& parts) {
  constexpr double kShare = 0.25;  // of the stability limit
  const Scene& scene = parts.scene;
  if (scene.time.substeps == kAutoSubsteps) return 0;
  const double below = kShare * parts.model.largest_substep();
  return scene.solver.full_first_kick ? std::min(below, Remainders::kFine) : below;
}

void Remainders::prepare(bool keeps, const Particles& particles) {
  kept = keeps;
  if (kept)
    make_room(*this, particles);
  else
    clear();
}

void Remainders::clear() {
  x.clear();
  v.clear();
}

void Remainders::keep(const Particles& particles, Keeper& keeper) {
  keeper(kept);
  if (!kept) {
    if (keeper.puts_back()) clear();
    return;
  }
  make_room(*this, particles);
  particles.keep(x, keeper);
  particles.keep(v, keeper);
}

}  // namespace weft::physics
