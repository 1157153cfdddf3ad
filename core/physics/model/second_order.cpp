// Stages "predict" and "velocity" of the second-order substep (kernels/second_order.cpp).
#include "physics/kernels/second_order.h"

#include <cassert>

#include "physics/model/path.h"
#include "physics/model/projected_motion.h"
#include "physics/step/keeper.h"

namespace weft::physics {
namespace {

// Rows j … end-1 as one long row, padding and all.
SecondOrderRow rows_of(const ClothParts& parts, History& h, Rows* corrections, int j, int end,
                       double dt) {
  Particles& l = parts.particles;
  const std::size_t lane = std::size_t(j) * l.stride;
  SecondOrderRow r{};
  r.columns = (end - j) * l.stride;
  r.dt = float(dt);
  r.x = l.x.row(j);
  r.v = l.v.row(j);
  r.previous = l.previous.row(j);
  r.v_before = h.v_before.row(j);
  r.v_end = h.v_end.row(j);
  const Left left = h.left.row(j);
  r.left = left.x;
  r.v_left = left.v;
  if (corrections) r.u = corrections->row(j);
  r.drag = float(parts.cloth.drag);
  r.w = l.w(j);
  r.mass = h.inverse_mass.data() + lane;
  return r;
}

class Predict final : public RowStage {
 public:
  Predict(const ClothParts& parts, History& history, Multipliers* multipliers, Rows* corrections)
      : RowStage("predict", "second order, from two substeps before", 0, parts.particles.count(),
                 "particles"),
        parts_(parts),
        history_(history),
        multipliers_(multipliers),
        corrections_(corrections),
        dt_(parts.particles.rows, 0.0) {}
  void restart() override {
    std::fill(dt_.begin(), dt_.end(), 0.0);
    history_.left.clear();
    const AlignedArray<float>& mass = parts_.particles.inverse_mass;
    std::copy_n(mass.data(), mass.size(), history_.inverse_mass.data());
  }
  void keep(Keeper& keeper) override {
    Particles& l = parts_.particles;
    keeper(dt_);
    history_.left.keep(l, keeper);
    for (Rows* rows : {&l.previous, &history_.v_before, &history_.v_end}) l.keep(*rows, keeper);
    for (int j = 0; j < l.rows; ++j)
      keeper.of(history_.inverse_mass.data() + std::size_t(j) * std::size_t(l.stride), l.count(j));
  }
  void prepare(double dt) override {
    history_.left.prepare(Remainders::fine(dt), parts_.particles);
  }
  // Where what the sweeps did is not in them yet, it adds that itself.
  Velocities velocities() const override {
    return corrections_ ? Velocities::left_alone : Velocities::used;
  }
  bool moves_particles() const override { return true; }
  void run(int begin, int end, const Substep& s) override {
    for (int first = begin; first < end;) {
      int last = first + 1;
      while (last < end && dt_[last] == dt_[first]) ++last;
      run_alike(first, last, s);
      first = last;
    }
    if (multipliers_) multipliers_->clear(begin, end);
  }

 private:
  void run_alike(int begin, int end, const Substep& s) {
    SecondOrderRow r = rows_of(parts_, history_, corrections_, begin, end, s.dt);
    const Vec3 g = gravity_at(parts_.scene, s.time);
    r.fresh = dt_[begin] != s.dt;
    std::fill(dt_.begin() + begin, dt_.begin() + end, s.dt);
    r.v_waits = !s.velocities_known;
    assert(!r.fresh || !r.v_waits);
    r.gx = float(g[0]);
    r.gy = float(g[1]);
    r.gz = float(g[2]);
    parts_.kernels.particles.predict_second_order(r);
  }

  ClothParts parts_;
  History& history_;
  Multipliers* multipliers_;
  Rows* corrections_;
  std::vector<double> dt_;  // s, of every row's substep before; 0 = none
};

class Velocity final : public RowStage {
 public:
  Velocity(const ClothParts& parts, History& history, Rows* corrections)
      : RowStage("velocity", "of the second order, kept for the next substep", 0,
                 parts.particles.count(), "particles"),
        parts_(parts),
        history_(history),
        corrections_(corrections) {}
  Velocities velocities() const override {
    return corrections_ ? Velocities::from_sweeps : Velocities::used;
  }
  void run(int begin, int end, const Substep& s) override {
    if (s.velocities_wanted)
      parts_.kernels.particles.velocity_second_order(
          rows_of(parts_, history_, corrections_, begin, end, s.dt));
  }

 private:
  ClothParts parts_;
  History& history_;
  Rows* corrections_;
};

}  // namespace

History::History(const Particles& l)
    : v_before(l.rows, l.stride),
      v_end(l.rows, l.stride),
      inverse_mass(std::size_t(l.rows) * l.stride) {
  std::copy_n(l.inverse_mass.data(), l.inverse_mass.size(), inverse_mass.data());
}

bool History::goes_on(const Particles& particles, int row, int column) const {
  const auto same = [&](int k) {
    return particles.v.at(k, row, column) == v_end.at(k, row, column);
  };
  return same(0) && same(1) && same(2);
}

void History::shift(Particles& particles, int component, int row, int column, float previous,
                    float v) {
  particles.previous.at(component, row, column) += previous;
  v_before.at(component, row, column) += v;
  v_end.at(component, row, column) += v;
}

std::unique_ptr<RowStage> make_predict_second_order(const ClothParts& parts, History& history,
                                                    Multipliers* multipliers, Rows* corrections) {
  return std::make_unique<Predict>(parts, history, multipliers, corrections);
}

std::unique_ptr<RowStage> make_velocity_second_order(const ClothParts& parts, History& history,
                                                     Rows* corrections) {
  return std::make_unique<Velocity>(parts, history, corrections);
}

}  // namespace weft::physics
