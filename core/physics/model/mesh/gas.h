// The gas in a closed mesh: what it encloses, what pressure that gives, and how it pushes the vertices.
//
// A point is a vertex, or the middle of those that seams join, so that the surface is closed from the start. The
// energy of the gas depends on the volume V alone, and the force on a point is p grad V, with grad V a third of
// the area vectors of its triangles; the vertices of a point have equal parts of it. So forces of all add up to
// nothing, and so do their moments, however the mesh lies.
#pragma once

#include <span>

#include "physics/model/particles.h"
#include "physics/step/stage.h"

namespace weft::physics {

// Pressure and energy by volume: constant, or of an ideal gas at constant temperature.
class GasLaw {
 public:
  // `volume`: enclosed at the start [m³]; above 0 for an ideal gas.
  GasLaw(Pressure pressure, double volume) : pressure_(std::move(pressure)), volume_(volume) {}

  bool ideal() const { return pressure_.inflate > 0; }
  double share(double time) const;  // of over, or of the amount of gas
  double greatest_share() const;    // at any time
  // Above that of the air about it [Pa].
  double over(double share, double volume) const;
  // The same at the end of a substep in which a pressure p makes of the volume one of `volume` + `growth` p.
  double over_after(double share, double volume, double growth) const;
  double stiffness(double share, double volume) const;  // -dp/dV [Pa/m³]
  // J; 0 of an ideal gas at ambient pressure, of a constant pressure at the volume of the start.
  double energy(double share, double volume) const;

 private:
  double at_ambient(double share) const { return pressure_.inflate * share * volume_; }
  double amount(double share) const { return pressure_.ambient * at_ambient(share); }
  // Below this volume the pressure grows no further.
  double least(double share) const { return 0.05 * at_ambient(share); }

  Pressure pressure_;
  double volume_;
};

class Gas {
 public:
  // The cloth's mesh is read and closed; the cloth outlives the gas.
  Gas(const Cloth& cloth, const Particles& particles);

  const GasLaw& law() const { return law_; }
  double volume_at_start() const { return volume_; }
  int points() const { return int(first_.size()) - 1; }
  int triangles() const { return int(triangles_.size()); }
  std::size_t bytes() const;

  // The vertices of a point: where they are, and their numbers.
  struct Member {
    Particles::Place place;
    int number;
  };
  std::span<const Member> members(int point) const {
    return {members_.data() + first_[std::size_t(point)],
            members_.data() + first_[std::size_t(point) + 1]};
  }

  // Values of points and triangles, in steps that each may be done in parts by several threads.
  struct Work {
    std::vector<Vec3> points;     // m
    std::vector<Vec3> normals;    // of triangles, twice their area long [m²]
    std::vector<Vec3> gradients;  // of the volume, at each vertex of a point [m²]
  };
  Work work() const;
  void gather(const Rows& x, RowSpan points, Work& work) const;
  // Returns six times what these triangles add to the volume.
  double measure(RowSpan triangles, Work& work) const;
  void derive(RowSpan points, Work& work) const;

  // All of it at once; returns the volume [m³].
  double look(const Rows& x, Work& work) const;
  double look(const std::vector<Vec3>& x, Work& work) const;  // by number
  // Area of the surface [m²].
  double area(const Work& work) const;
  // Row sums of the second derivative of the volume, at most [m]: how far forces turn as vertices move.
  double turning(const Work& work, int point) const;

 private:
  double finish(Work& work) const;

  std::vector<std::array<int, 3>> triangles_;  // of points, looking outwards
  std::vector<int> first_;                     // member of each point
  std::vector<Member> members_;
  std::vector<int> around_first_, around_;  // triangles about each point, ascending
  double volume_ = 0;                       // m³, at the start
  GasLaw law_;
};

}  // namespace weft::physics
