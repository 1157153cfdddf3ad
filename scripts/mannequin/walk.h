// How the figure walks: from where it stands it lowers its arms, walks ahead and then in a circle. Feet are
// planted where the body will be above them, legs follow by the law of cosines, arms swing against the legs.
#pragma once

#include <map>
#include <vector>

#include "figure.h"

namespace mannequin {

// Where a bone is: x becomes at + turn (x - from).
struct Pose {
  Rotation turn;
  Vec from, at;
  Vec operator()(Vec x) const { return at + turn * (x - from); }
};

struct Body {
  std::vector<std::pair<BoneOf, Pose>> bones;
  const Pose& of(BoneOf bone) const;
};

// The bones at a time [s].
Body pose_at(const Joints& joints, double time);

}  // namespace mannequin
