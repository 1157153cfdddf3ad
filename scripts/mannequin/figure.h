// The figure: rounded cones on bones, and the distance from the surface that blends them.
#pragma once

#include <initializer_list>
#include <span>
#include <vector>

#include "vector.h"

namespace mannequin {

enum class Bone { pelvis, waist, chest, neck, head, upper_arm, forearm, hand, thigh, shin, foot };

// A bone of one side of the body; the bones in the middle have side 0.
struct BoneOf {
  Bone bone;
  int side;  // -1: right, 1: left
  friend bool operator==(const BoneOf&, const BoneOf&) = default;
};

// All points within a radius of an axis, which goes over from one end to the other.
struct Cone {
  BoneOf of;
  Vec a, b;
  double ra, rb;  // m
};

// Joints of the left side, as the figure stands to begin with: feet on y = 0, looking along z, arms off the body.
struct Joints {
  Vec pelvis{0, 0.96, 0}, waist{0, 1.05, 0.0}, chest{0, 1.2, -0.005}, neck{0, 1.45, -0.02},
      head{0, 1.54, 0.0};
  Vec hip{0.095, 0.92, 0}, knee{0.12, 0.5, 0.012}, ankle{0.135, 0.085, -0.02};
  Vec ball{0.15, 0.03, 0.1}, heel{0.133, 0.03, -0.06};
  Vec shoulder{0.172, 1.4, -0.012}, elbow{0.331, 1.165, -0.02}, wrist{0.467, 0.963, 0.0};
};

// m; of the point from a cone.
double distance(const Cone& cone, Vec p);
// Two distances, blended where they differ by less than `by`.
double blended(double a, double b, double by);

class Figure {
 public:
  Figure();
  const std::vector<Cone>& cones() const { return cones_; }
  const Joints& joints() const { return joints_; }
  // m; of the whole body; of what a shirt covers.
  double body(Vec p) const;
  double sleeves(Vec p) const;

 private:
  using Group = std::span<const Cone>;
  void add(const Cone& cone);
  // The cones of a bone.
  Group at(Bone bone, int side = 0) const;
  double of(Vec p, std::initializer_list<Group> groups, double by) const;
  double trunk(Vec p) const;

  Joints joints_;
  std::vector<Cone> cones_;
};

}  // namespace mannequin
