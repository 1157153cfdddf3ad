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

bool slows_down(const ClothParts& parts) {
  const Cloth& c = parts.cloth;
  const Kinds& springs = c.spring_damping;
  const bool friction = parts.method == Method::spring_friction &&
                        (springs.structural > 0 || springs.shear > 0 || springs.bend > 0);
  return friction || c.drag > 0 || c.membrane.damping > 0 || c.bending.damping > 0;
}

}  // namespace

double forces_keep_below(const ClothParts& parts) {
  constexpr double kFarther = 0.5;                                    // of the stability limit
  const bool automatic = parts.scene.time.substeps == kAutoSubsteps;  // as long as the limit allows
  if (automatic || !slows_down(parts)) return 0;
  const Spectrum spectrum = parts.model.spectrum(parts.particles.inverse_mass.span());
  return std::min(Remainders::kFine, kFarther * spectrum.largest_substep());
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
