// Stages "predict" and "velocity" of the methods that project positions: before the sweeps every
// particle moves by its velocity and gravity, after them the velocity is what it moved by.
#include "physics/stages/stages.h"

namespace weft::physics {
namespace {

AdvanceRow row_of(const ClothParts& parts, int j) {
  Lattice& l = parts.lattice;
  AdvanceRow a{};
  a.columns = l.columns;
  a.x = l.x.row(j);
  a.v = l.v.row(j);
  a.w = l.w(j);
  a.previous = l.previous.row(j);
  return a;
}

class Predict final : public RowStage {
 public:
  Predict(const ClothParts& parts, Multipliers* multipliers)
      : RowStage("predict", "positions by velocity and gravity", 0, parts.particles(), "particles"),
        parts_(parts),
        multipliers_(multipliers) {}
  void run(int j, const Substep& s) override {
    AdvanceRow a = row_of(parts_, j);
    a.advance = advance_of(parts_, s.dt);
    parts_.kernels.predict(a);
    if (multipliers_) multipliers_->clear(j);
  }

 private:
  ClothParts parts_;
  Multipliers* multipliers_;
};

class Velocity final : public RowStage {
 public:
  Velocity(const ClothParts& parts, bool compliant)
      : RowStage("velocity", "from the change of position", 0, parts.particles(), "particles"),
        parts_(parts),
        compliant_(compliant) {}
  void run(int j, const Substep& s) override {
    if (!velocity_from_positions(parts_.scene.solver, compliant_, s.dt)) return;
    AdvanceRow a = row_of(parts_, j);
    a.inverse_dt = float(1 / s.dt);
    parts_.kernels.velocity(a);
  }

 private:
  ClothParts parts_;
  bool compliant_;
};

}  // namespace

Multipliers::Multipliers(const Lattice& lattice, std::size_t families_)
    : rows(lattice.rows),
      stride(lattice.stride),
      families(families_),
      data(families_ * static_cast<std::size_t>(lattice.rows) * lattice.stride) {}

float* Multipliers::row(std::size_t family, int j) {
  return data.data() + (family * rows + j) * stride;
}

void Multipliers::clear(int j) {
  for (std::size_t f = 0; f < families; ++f) std::fill_n(row(f, j), stride, 0.0f);
}

std::unique_ptr<RowStage> make_predict(const ClothParts& parts, Multipliers* multipliers) {
  return std::make_unique<Predict>(parts, multipliers);
}

std::unique_ptr<RowStage> make_velocity(const ClothParts& parts, bool compliant) {
  return std::make_unique<Velocity>(parts, compliant);
}

}  // namespace weft::physics
