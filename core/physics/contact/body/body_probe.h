// How the surface of a body that is a mesh lies to the particles of a cloth, for the kernels of its stages.
//
// Of every particle is kept what was found at some place near to where it is. Whatever is as near to p as
// the surface is within |d(q)| + 2 |p - q| of q: a list of the triangles so far from q is enough until p has
// left it, and what is farther than it has to be is not looked at at all. Where the body moves, q goes along
// with the surface nearest to it, and the list is of all triangles that come so near to it until the body's next
// sample.
#pragma once

#include <vector>

#include "physics/contact/body/body_passage.h"
#include "physics/model/particles.h"
#include "physics/step/stage.h"

namespace weft::physics {

class BodyProbe {
 public:
  BodyProbe(const BodySurface& surface, const Particles& particles);

  // Looks at row j and gives the kernels what it finds: exact where the surface is nearer than the offset
  // and the bias, or than the particle and the surface have come in this substep; else the distance is a lower
  // bound.
  void look(CollideRow& row, const BodyPassage& body, int j, const Substep& s);
  std::size_t bytes() const;

 private:
  struct Near {
    Vec3 at{};                  // q, seen from the body's place
    Vec3 drift{};               // m/s, of q
    double time = 0;            // s; when it was at q
    double begin = 0, end = 0;  // s; the list is enough between them
    double distance = -1;       // d(q) [m]
    double margin = 0;          // m; the list is enough within half of it
    int triangle = 0;
    int listed = 0;
    std::array<int, BodyMoment::kListed> list;
  };
  // One row and the body, in one substep.
  struct Look {
    const CollideRow& row;
    const BodyPassage& body;
    const Substep& s;
  };

  void look(const Look& look, int j, int i);
  BodyMoment::Point nearest(Near& near, const Look& look, bool now, const Vec3& p);
  void list_standing(Near& near, const Look& look) const;
  void list_moving(Near& near, const Look& look, const BodyMoment::Point& point) const;

  const BodySurface& surface_;
  int stride_;
  std::vector<Near> near_;
  Rows normal_, normal_before_, velocity_;
  AlignedArray<float> distance_, distance_before_;
  std::vector<FoundSurface> found_;  // of each row
};

}  // namespace weft::physics
