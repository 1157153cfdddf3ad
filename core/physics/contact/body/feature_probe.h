// Which edges and corners of a body that is a mesh are near to the triangles of a cloth.
#pragma once

#include "physics/contact/body/near_features.h"
#include "physics/contact/moving_collider.h"

namespace weft::physics {

class FeatureProbe {
 public:
  FeatureProbe(const BodySurface& surface, const ClothParts& parts);

  // Those about a triangle of which particle i of row j is a corner, for deepest_among() with any offset up to the
  // row's.
  std::span<const int> about(const ColliderRow& row, const Corners& c, double edge, int j, int i);
  // Nothing is known: triangles are elsewhere, or at an earlier time.
  void forget();
  std::size_t bytes() const;

 private:
  // Particles that lie beside each other, and what is near to the triangles that begin there.
  struct Group {
    std::vector<int> lanes;
    NearFeatures near;
    int triangle = 0;  // of the body, that may be near
  };
  void renew(Group& group, const ColliderRow& row, const AboutTriangle& triangle, int j) const;

  const Particles& particles_;
  const SheetKernels& kernels_;
  std::vector<std::vector<Group>> groups_;  // of each row
  std::vector<std::vector<int>> group_of_;  // of each lane of a row
};

}  // namespace weft::physics
