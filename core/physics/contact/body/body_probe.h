// How the surface of a body that is a mesh lies to the particles of a cloth, for the kernels of its stages.
//
// Of every particle is kept what was found at some place near to where it is. Whatever is as near to p as
// the surface is within |d(q)| + 2 |p - q| of q: a list of the triangles so far from q is enough until p has
// left it, and what is farther than it has to be is not looked at at all.
#pragma once

#include <vector>

#include "physics/contact/body/body_surface.h"
#include "physics/model/particles.h"

namespace weft::physics {

class BodyProbe {
 public:
  BodyProbe(const BodySurface& surface, const Particles& particles);

  // Looks at row j and gives the kernels what it finds: exact where the surface is nearer than the offset
  // and the bias, or than the particle has come in this substep; else the distance is a lower bound.
  void look(CollideRow& row, int j);
  std::size_t bytes() const;

 private:
  struct Near {
    Vec3 at{};             // q, seen from the body's place
    double distance = -1;  // d(q) [m]
    double margin = 0;     // m; the list is enough within half of it
    int triangle = 0;
    int listed = 0;
    std::array<int, BodySurface::kListed> list;
  };

  void look(const CollideRow& row, int j, int i);
  // `keep`: what is found there is what is kept.
  BodySurface::Point nearest(Near& near, const Vec3& p, bool keep);

  const BodySurface& surface_;
  int stride_;
  std::vector<Near> near_;
  Rows normal_, normal_before_;
  AlignedArray<float> distance_, distance_before_;
  std::vector<FoundSurface> found_;  // of each row
};

}  // namespace weft::physics
