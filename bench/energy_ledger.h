// What energy one sheet may have, by what was put in: a bound that every stable run keeps, whatever its
// method (stress_case.h says what counts).
#pragma once

#include <vector>

#include "physics/model/lattice/stencil.h"
#include "weft/simulation.h"

namespace bench {

using weft::Vec3;

// Where the particle (i, j) of a flat sheet lies [m]; also between particles.
Vec3 grid_point(const weft::Grid& g, double i, double j);
bool pinned(const weft::Cloth& cloth, int i, int j);

// Whether springs, or a membrane, run as forces, now.
bool runs_springs(const weft::Simulation& simulation);

// Energies of the first sheet of a scene as its bound counts them.
class Ledger {
 public:
  // Constraints are springs, or projected every dt [s].
  Ledger(const weft::Scene& scene, bool springs, double dt);
  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;

  // The start: positions [m] and velocities [m/s].
  void open(std::vector<Vec3> x, const std::vector<Vec3>& v);

  // From here on constraints are projected every dt [s].
  void project_every(double dt);

  // The energy of a state, and what has been put in so far [J].
  struct Balance {
    double held = 0, put_in = 0;
    double share() const { return held == 0 ? 0 : held / put_in; }  // all of it may be pinned
  };
  Balance balance(const std::vector<Vec3>& x, const std::vector<Vec3>& v);

 private:
  double mass(std::size_t p) const;
  double mass_of_all() const;
  double kinetic(const std::vector<Vec3>& v) const;
  double gravity(const std::vector<Vec3>& x) const;
  double rigid(std::size_t a, std::size_t b) const;
  double felt(std::size_t a, std::size_t b, double k) const;
  double bent(const std::vector<Vec3>& x) const;
  double elastic(const std::vector<Vec3>& x) const;
  double tethered(const std::vector<Vec3>& x) const;
  double noise(const std::vector<Vec3>& x) const;
  template <class Visit>
  double sum_of(Visit&& visit) const;

  weft::Scene scene_;
  const weft::Cloth& cloth_;
  std::vector<weft::physics::Stencil> stencils_;
  bool springs_;
  double dt_;
  double put_in_ = 0, highest_ = 0, released_ = 0;  // J
};

}  // namespace bench
