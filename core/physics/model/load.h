// A load on a cloth that has an energy of its own, such as a gas that it encloses, and may change over time.
#pragma once

#include <vector>

#include "weft/scene.h"

namespace weft::physics {

class Load {
 public:
  virtual ~Load() = default;

  // Of the cloth as it lies, at a time [s]: adds to the accelerations of free particles, by number [m/s²]; and
  // the energy [J].
  virtual void add_accelerations(double time, std::vector<Vec3>& a) const = 0;
  virtual double energy(double time) const = 0;
  // Of particles at such positions, by number, where the load is greatest [J].
  virtual double greatest_energy(const std::vector<Vec3>& x) const = 0;
  // Energy that the load may still give to a cloth that is stretched by no more than half, beyond what
  // greatest_energy() has of it [J].
  virtual double reserve() const = 0;
  // 1/s²; by how much it raises ω² of explicit substeps at most, as the cloth lies.
  virtual double omega_squared() const = 0;
  virtual bool changes() const = 0;  // over time
};

}  // namespace weft::physics
