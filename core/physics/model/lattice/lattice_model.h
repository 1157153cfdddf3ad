// A cloth as a grid of particles joined by the constraints of stencils (stencil.h), with bending and
// tearing: the model of rectangular sheets.
#pragma once

#include "physics/model/cloth_model.h"
#include "physics/model/colour_sweeps.h"
#include "physics/model/followed.h"
#include "physics/model/lattice/membrane.h"
#include "physics/model/lattice/stages.h"
#include "physics/model/lattice/tearing.h"

namespace weft::physics {

class LatticeModel final : public ClothModel {
 public:
  LatticeModel(const Scene& scene, int index, Method method, std::uint64_t seed,
               const KernelTable& kernels);

  const ClothParts& parts() const override { return parts_; }
  LatticeParts* lattice() override { return &parts_; }

  History* history() override { return history_.get(); }
  void append_motion(Method method, StageList& list) override;
  void append_limits(StageList& list) override;
  bool take_substep(double dt) override;
  double mass(int particle) const override;

  const SurfaceMesh& surface() const override;
  ConstraintCounts constraints() const override;
  Pull pull() const override;
  void accelerations(const Vec3& gravity, std::vector<Vec3>& a) const override;
  ElasticEnergy elastic_energy() const override;
  Strain strain() const override;
  double limited_strain() const override;
  Vec3 pin_position(const Pin& pin, double time) const override;
  double held_energy(const Rows& x, double dt, Threads& threads) const override;
  float greatest_stretch(const Rows& x) const override;
  double strain_in_line(const Rows& x, double spread) const override;
  double attachment_energy(const Rows& x, double dt) const override;
  double rounding_gain() const override;
  Spectrum find_spectrum(std::span<const float> inverse_masses) const override;
  double stiffening(double stretch) const override;
  bool folds_freely() const override;
  std::vector<std::string> notes() const override;

  Tearing* tearing() override { return tearing_.get(); }
  const Tearing* tearing() const override { return tearing_.get(); }
  void allow_tearing() override;
  std::vector<Joined> constraints_near(const Vec3& a, const Vec3& way,
                                       double distance) const override;
  std::size_t bytes() const override;

 private:
  void append_forces(StageList& list);
  void append_projections(StageList& list);
  double stiffness_rate() const;
  ColourSweeps sweeps_due() const;
  std::vector<Joined> cut_constraints() const;  // that the cloth's cuts cross
  SurfaceMesh whole_surface() const;
  const BendLinks* bend_links() const { return tearing_ ? tearing_->bend_links() : nullptr; }
  double stretch_energy(const Rows& x, double dt, Threads& threads) const;
  double stretch_energy(const Rows& x, StretchRow r, RowSpan rows) const;
  StretchRow stretch_row(const Rows& x, double dt) const;
  double membrane_energy(const Rows& x) const;
  double greatest_coordinate(const Rows& x) const;
  // Whether the membrane's own forces act, or sweeps solve it, and not springs in its place.
  bool is_membrane() const { return parts_.cloth.membrane.given() && is_explicit(method_); }
  bool solves_membrane() const {
    return parts_.cloth.membrane.given() && method_ == Method::compliant &&
           parts_.scene.solver.sweep != Sweep::jacobi;
  }
  MembraneCells membrane() const;

  const int index_;
  const std::uint64_t seed_;
  Method method_;
  std::vector<Stencil> stencils_;
  Lattice lattice_;
  LatticeParts parts_;
  Followed followed_;
  double dt_ = 0;  // s, of substeps; 0: not known yet
  ColourSweeps sweeps_{};
  std::unique_ptr<Multipliers> multipliers_, limit_forces_;
  std::unique_ptr<Rows> corrections_;
  std::unique_ptr<History> history_;
  std::vector<std::uint8_t> overlong_;
  std::vector<std::int32_t> ended_;
  std::unique_ptr<LatticeTearing> tearing_;
  mutable SurfaceMesh surface_;  // as last asked for
};

}  // namespace weft::physics
