// Seams of a mesh: groups of vertices that are drawn together and then move as one.
//
// Drawn, the vertex of a group that is farthest from its centre comes nearer to it at kSewingSpeed at least,
// whatever pulls it away: each is moved along its way to the centre as that was before the substep, by an impulse
// in proportion to its mass and distance. So impulses of a group are equal and opposite, act along the lines
// between its members, and keep momentum and angular momentum. The second order, whose forces are those of the
// substep's end, draws along the way there, and sets places and speeds to what is asked for (draw_smoothly()).
//
// What is as near as a substep draws is joined: all get the place and the velocity of the centre, and so the motion
// of one particle of all their masses. The centre is that of mass, or the place of what is held.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "physics/model/cloth_model.h"

namespace weft::physics {

inline constexpr double kSewingSpeed = 0.5;  // m/s

class Seams {
 public:
  // `groups`: of numbers of particles.
  Seams(const std::vector<std::vector<int>>& groups, const Particles& particles);

  int count() const { return int(first_.size()) - 1; }
  std::span<const Particles::Place> members(int group) const {
    return {members_.data() + first_[std::size_t(group)],
            members_.data() + first_[std::size_t(group) + 1]};
  }
  // Groups belong to the first row that they reach, and are in the order of rows.
  RowSpan in_rows(int begin, int end) const {
    return {begin_[std::size_t(begin)], begin_[std::size_t(end)]};
  }
  int reach() const { return reach_; }
  // How many are apart now, and the farthest that a member is from its centre [m].
  OpenSeams open(const Particles& particles) const;
  // Marks, by number, the members of groups that have one farther from its centre than so much [m].
  void mark_open(const Particles& particles, double beyond, std::span<std::uint8_t> marks) const;
  // Gives all members of a group that is closed the mean of their accelerations by mass, none where one is held.
  void share(const Particles& particles, std::vector<Vec3>& accelerations) const;
  std::size_t bytes() const;

 private:
  auto weights(int group, const Particles& particles) const;
  double width(int group, const Particles& particles) const;

  std::vector<Particles::Place> members_;  // group after group
  std::vector<int> first_;                 // member of each group, and how many there are
  std::vector<int> begin_;                 // group of each row, and how many there are
  int reach_ = 0;                          // rows
};

// "sewing": draws groups together and holds them; or, after stages that move particles one by one, holds
// those that were together. `history`: of the second order, else null. Null: there are no seams.
std::unique_ptr<RowStage> make_sewing(const ClothParts& parts, const Seams& seams,
                                      History* history);
std::unique_ptr<RowStage> make_seam_hold(const ClothParts& parts, const Seams& seams,
                                         History* history);
// Between sweeps over a mesh's records (kernels/mesh_sweep.h): what is together as they begin stays so.
std::unique_ptr<RowStage> make_seam_sweep(const ClothParts& parts, const Seams& seams,
                                          AlignedArray<float>& records);

}  // namespace weft::physics
