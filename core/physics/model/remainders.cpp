// What rounding leaves (remainders.h).
#include "physics/model/remainders.h"

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
  constexpr double kFine = 0.25;                                      // of the stability limit
  const bool automatic = parts.scene.time.substeps == kAutoSubsteps;  // as long as the limit allows
  if (automatic) return 0;
  return kFine * parts.model.largest_substep();
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
