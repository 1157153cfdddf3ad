// Stages "predict" and "velocity" of the methods that project positions: before the sweeps every
// particle moves by its velocity and gravity, after them both position and velocity gain the corrections
// that the sweeps have found. Between substeps where nobody else looks that is left to the next predict
// (step/schedule.h).
#include "physics/model/projected_motion.h"

namespace weft::physics {
namespace {

// Rows begin … end-1 as one long row, padding and all.
AdvanceRow rows_of(const ClothParts& parts, Remainders* left, int begin, int end) {
  Particles& l = parts.particles;
  AdvanceRow a{};
  a.columns = (end - begin) * l.stride;
  a.x = l.x.row(begin);
  a.v = l.v.row(begin);
  a.w = l.w(begin);
  if (left) a.left = left->row(begin);
  return a;
}

class Predict final : public RowStage {
 public:
  Predict(const ClothParts& parts, Multipliers* multipliers, Rows* corrections,
          std::shared_ptr<Remainders> left)
      : RowStage("predict", "positions by velocity and gravity", 0, parts.particles.count(),
                 "particles"),
        parts_(parts),
        multipliers_(multipliers),
        corrections_(corrections),
        left_(std::move(left)) {}
  // Where what the sweeps did is not in them yet, it adds that itself.
  Velocities velocities() const override { return Velocities::left_alone; }
  bool moves_particles() const override { return true; }
  void prepare(double dt) override {
    if (left_) left_->prepare(Remainders::fine(dt), parts_.particles);
  }
  void restart() override {
    if (left_) left_->clear();
  }
  void keep(Keeper& keeper) override {
    if (left_) left_->keep(parts_.particles, keeper);
  }
  std::size_t bytes() const override { return left_ ? left_->bytes() : 0; }
  void run(int begin, int end, const Substep& s) override {
    AdvanceRow a = rows_of(parts_, left_.get(), begin, end);
    a.advance = advance_of(parts_, s);
    if (!s.velocities_known && corrections_) {
      a.inverse_dt = velocity_gain(parts_.scene.solver, s.dt);
      a.f = corrections_->row(begin);
    }
    parts_.kernels.particles.predict(a);
    if (multipliers_) multipliers_->clear(begin, end);
  }

 private:
  ClothParts parts_;
  Multipliers* multipliers_;
  Rows* corrections_;
  const std::shared_ptr<Remainders> left_;
};

// What sweeps have found goes into positions and velocities.
class Corrections final : public RowStage {
 public:
  Corrections(const ClothParts& parts, Rows& corrections, std::shared_ptr<Remainders> left)
      : RowStage("velocity", "positions and velocities gain the corrections", 0,
                 parts.particles.count(), "particles"),
        parts_(parts),
        corrections_(corrections),
        left_(std::move(left)) {}
  Velocities velocities() const override { return Velocities::from_sweeps; }
  void run(int begin, int end, const Substep& s) override {
    if (!s.velocities_wanted) return;
    AdvanceRow a = rows_of(parts_, left_.get(), begin, end);
    a.w = nullptr;  // they are weighed already
    a.f = corrections_.row(begin);
    a.inverse_dt = velocity_gain(parts_.scene.solver, s.dt);
    parts_.kernels.particles.apply_corrections(a);
  }

 private:
  ClothParts parts_;
  Rows& corrections_;
  const std::shared_ptr<Remainders> left_;
};

}  // namespace

Multipliers::Multipliers(const Particles& particles, std::size_t stencils_)
    : rows(particles.rows),
      stride(particles.stride),
      stencils(stencils_),
      data(stencils_ * static_cast<std::size_t>(particles.rows) * particles.stride) {}

float* Multipliers::row(std::size_t stencil, int j) {
  return data.data() + (stencil * rows + j) * stride;
}

void Multipliers::clear(int begin, int end) {
  for (std::size_t f = 0; f < stencils; ++f) std::fill(row(f, begin), row(f, end), 0.0f);
}

std::unique_ptr<RowStage> make_predict(const ClothParts& parts, Multipliers* multipliers,
                                       Rows* corrections, std::shared_ptr<Remainders> left) {
  return std::make_unique<Predict>(parts, multipliers, corrections, std::move(left));
}

std::unique_ptr<RowStage> make_corrections(const ClothParts& parts, Rows& corrections,
                                           std::shared_ptr<Remainders> left) {
  return std::make_unique<Corrections>(parts, corrections, std::move(left));
}

}  // namespace weft::physics
