// The gas in a mesh, as its stage and as a load that is measured.
#pragma once

#include "physics/model/cloth_model.h"
#include "physics/model/load.h"
#include "physics/model/mesh/gas.h"
#include "physics/model/mesh/seams.h"

namespace weft::physics {

class GasLoad final : public Load {
 public:
  // All outlive the load.
  GasLoad(const ClothParts& parts, const Seams& seams);

  const Gas& gas() const { return gas_; }
  void add_accelerations(double time, std::vector<Vec3>& a) const override;
  double energy(double time) const override;
  double greatest_energy(const std::vector<Vec3>& x) const override;
  double reserve() const override;
  double omega_squared() const override;
  bool changes() const override { return !parts_.cloth.pressure.keys.empty(); }
  std::size_t bytes() const { return gas_.bytes(); }

 private:
  ClothParts parts_;
  const Seams& seams_;
  Gas gas_;
  mutable Gas::Work work_;  // kept, since it is asked every frame
};

// "pressure". With explicit methods a force at the start of a substep, which goes into velocities before what
// moves particles; with those that project it comes after predict, with the pressure at the end of the substep:
// the volume is a degree of freedom by itself, which is solved for, so that no stiffness of the gas is too much.
// `history`: of the second order, else null.
std::unique_ptr<Stage> make_pressure(const ClothParts& parts, const Gas& gas, History* history);

}  // namespace weft::physics
