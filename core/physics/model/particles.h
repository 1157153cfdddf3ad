// The state of one cloth's particles: rows in separate component arrays (structure of arrays), each
// 64-byte aligned, each row padded by at least 16 lanes. A row of a grid is a row; work on row j touches
// rows j … j+reach (step/stage.h) whatever the rows stand for.
//
// Particles are numbered row after row, unless an order of their own is given. Arrays of one value for each, as those in double precision that
// measure a run, are in that order.
#pragma once

#include <vector>

#include "physics/step/rows.h"
#include "weft/scene.h"

namespace weft::physics {

class Keeper;

struct Particles {
  // As many rows as `counts`, each with so many particles, all at rest at zero and held.
  // `keep_previous`: with room for earlier positions. `numbers`: of the particles, row after row; empty:
  // 0, 1, 2 …
  Particles(const std::vector<int>& counts, bool keep_previous, std::vector<int> numbers = {});

  int rows, stride;        // stride: floats from one row to the next
  std::vector<int> first;  // how many particles there are in the rows before each, and in all
  Rows x;                  // position [m]
  Rows v;                  // velocity [m/s]
  // Earlier positions, where a stage asks for them: as predicted, or, for the second order, before the
  // substep.
  Rows previous;
  AlignedArray<float> inverse_mass;  // 1/kg, 0 = held or padding
  // Width of cloth that each column of the rows stands for, of an inner one's, and its reciprocal: 1/2
  // and 2 at both sides of a grid that lumps by area, else 1.
  AlignedArray<float> column_width, inverse_width;
  // 1/kg, of the particles of row j but for their inverse_width, or 0 where they differ otherwise:
  // kernels for a row of equal masses are faster.
  AlignedArray<float> row_inverse_mass;

  int count() const { return first.back(); }
  int count(int j) const { return first[std::size_t(j) + 1] - first[std::size_t(j)]; }
  // The place of a particle by its number, and the other way round.
  struct Place {
    int j, i;  // row, lane in it
  };
  Place place(int particle) const;
  int number(int j, int i) const {
    const int slot = first[std::size_t(j)] + i;
    return numbers_.empty() ? slot : numbers_[std::size_t(slot)];
  }
  // Where its values are in the component arrays.
  std::size_t lane(int particle) const {
    const Place p = place(particle);
    return std::size_t(p.j) * stride + p.i;
  }

  Vec3 position(int j, int i) const { return {x.at(0, j, i), x.at(1, j, i), x.at(2, j, i)}; }
  // Calls visit(j, i) for every particle, in the order of their numbers.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const int slot : slots_) {
      const Place p = place_of_slot(slot);
      visit(p.j, p.i);
    }
    for (int j = 0; slots_.empty() && j < rows; ++j)
      for (int i = 0, n = count(j); i < n; ++i) visit(j, i);
  }
  // Positions or velocities in double precision.
  std::vector<Vec3> gather(const Rows& values) const;

  // Keeps rows of this shape, or puts them back, without their padding.
  void keep(Rows& values, Keeper& keeper) const;

  // Changes the inverse mass of one particle.
  void set_inverse_mass(int j, int i, float value);
  // To be called after the inverse masses of row j were changed through w().
  void weigh_row(int j);
  float* w(int j) { return inverse_mass.data() + static_cast<std::size_t>(j) * stride; }
  const float* w(int j) const { return inverse_mass.data() + static_cast<std::size_t>(j) * stride; }
  float w(int j, int i) const { return inverse_mass[static_cast<std::size_t>(j) * stride + i]; }
  std::size_t bytes() const {
    return x.bytes() + v.bytes() + previous.bytes() + inverse_mass.size() * sizeof(float) +
           (numbers_.size() + slots_.size()) * sizeof(int);
  }

 private:
  Place place_of_slot(int slot) const;
  std::vector<int> numbers_;  // of the particles, row after row; empty: 0, 1, 2 …
  std::vector<int> slots_;    // the other way round
};

// Gives free particles a velocity [m/s] and a spin [rad/s] about the center of all masses [kg].
void set_in_motion(Particles& particles, const Vec3& velocity, const Vec3& spin,
                   const std::vector<double>& masses);

// Row j with positions x and velocities v, as the energy_sum is made of it.
EnergyRow energy_row(const Particles& particles, ConstRow3 x, ConstRow3 v, int j,
                     const Vec3& gravity);
// What rows have together.
inline EnergySum& operator+=(EnergySum& all, const EnergySum& more) {
  all.kinetic += more.kinetic;
  all.potential += more.potential;
  all.greatest = std::max(all.greatest, more.greatest);
  return all;
}

}  // namespace weft::physics
