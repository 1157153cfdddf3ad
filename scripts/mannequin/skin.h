// The skin: which bones a vertex follows, and where it is when they have moved.
#pragma once

#include "net.h"
#include "walk.h"

namespace mannequin {

class Skin {
 public:
  Skin(const Figure& figure, const Mesh& mesh);
  std::vector<Vec> at(double time) const;

 private:
  using Weights = std::vector<double>;  // of the bones

  const Figure& figure_;
  const Mesh& mesh_;
  std::vector<BoneOf> bones_;
  std::vector<Weights> weights_;
};

}  // namespace mannequin
