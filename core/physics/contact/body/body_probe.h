// How the surface of a body that is a mesh lies to the particles of a cloth, for the kernels of its stages.
//
// Of every particle is kept how far the surface was, at least, when it was last looked at: what has moved so little
// since that it cannot touch is not looked at again. Others ask for the nearest of the triangles that come near to
// them and to those beside them in their row (near_triangles.h).
#pragma once

#include <vector>

#include "physics/contact/body/near_triangles.h"
#include "physics/contact/moving_collider.h"

namespace weft::physics {

class BodyProbe {
 public:
  BodyProbe(const BodySurface& surface, const ClothParts& parts);

  // Looks at row j and gives the kernels what it finds: exact where the surface is nearer than the offset
  // and the bias, or than the particle and the surface have come in this substep; else the distance is a lower
  // bound.
  void look(ColliderRow& row, int j, const Substep& s);
  // Nothing is known: particles are elsewhere, or at an earlier time. What was near where they had gone astray would be
  // looked through ever after.
  void forget();
  std::size_t bytes() const;

 private:
  // What is known of a particle from when it was looked at.
  struct Known {
    Vec3 seen{};            // where it was, from what goes along
    double time = 0;        // s
    double least = -1e300;  // m; of its distance
    int triangle = 0;       // that may be near
  };
  // Particles of a row that lie beside each other, and what comes near to them.
  struct Group {
    std::vector<int> lanes;
    NearTriangles near;
    int triangle = 0;  // the nearest that was found last
  };
  // One group and the body, in one substep.
  struct Look {
    const ColliderRow& row;
    const BodyPassage& body;
    const Substep& s;
    Group& group;
    NearTriangles::Placed &now, &before;
    NearTriangles::Nearest& found;
  };
  struct Path {
    Vec3 before, now;
    double limit;  // m; what is farther does not matter
  };

  std::size_t lane(int j, int i) const {
    return std::size_t(j) * std::size_t(stride_) + std::size_t(i);
  }
  void look(const Look& look, int j, int i);
  Path path(const Look& look, int i) const;
  // At least the distance of p at a time.
  double least(const Known& known, const NearTriangles& near, const Vec3& p, double time) const;
  void keep(Known& known, const NearTriangles& near, const Vec3& p, double time,
            double least) const;
  // Whether what is known to be near does not do for p at a time.
  bool worn(const NearTriangles& near, const Vec3& p, double time, double limit) const;
  void renew(const Look& look, int j);
  BodyMoment::Point nearest(const Look& look, bool now, const Vec3& p, Known& known) const;

  const BodySurface& surface_;
  const BodyKernels& kernels_;
  int stride_;
  std::vector<std::vector<Group>> groups_;  // of each row
  std::vector<Known> known_;
  Rows normal_, normal_before_, velocity_;
  AlignedArray<float> distance_, distance_before_;
  std::vector<FoundSurface> found_;  // of each row
};

}  // namespace weft::physics
