// How the surface of a body that is a mesh lies to the particles of a cloth, for the kernels of its stages.
//
// Of every particle is kept what was found at some place q near to where it is. Whatever is as near to p as the
// surface is within |d(q)| + 2 |p - q| of q: a list of the triangles so far from q is enough until p has left it,
// and what is farther than it has to be is not looked at at all. Where the body moves, q goes along with the
// surface nearest to it until the body's next sample, and what counts is how much farther others come than q.
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
  // What is known near to q from one time to another.
  struct Near {
    Vec3 at{};                  // q, seen from the body's place
    Vec3 drift{};               // m/s, of q
    double time = 0;            // s; when it was at q
    double begin = 1, end = 0;  // s
    double margin = 0;          // m; the list is enough within half of it
    double known = 0;           // m; within that a distance is known to be no less
    double distance = 0;        // d(q) at that time [m]
    double loose = 0;           // m; no nearer surface comes farther, seen from q
    int triangle = 0;
    int listed = 0;  // of the triangles that can be nearest; none where they are many
    std::array<int, BodyMoment::kListed> list;

    // How far from q a place is at a time [m]; out of reach at other times.
    double apart(const Vec3& p, double when) const;
  };
  // One row and the body, in one substep.
  struct Look {
    const CollideRow& row;
    const BodyPassage& body;
    const Substep& s;
  };

  void look(const Look& look, int j, int i);
  BodyMoment::Point nearest(Near& near, const Look& look, bool now, const Vec3& p);
  void know_standing(Near& near, const Look& look) const;
  void know_moving(Near& near, const Look& look, const BodyMoment::Point& point) const;

  const BodySurface& surface_;
  int stride_;
  std::vector<Near> near_;
  Rows normal_, normal_before_, velocity_;
  AlignedArray<float> distance_, distance_before_;
  std::vector<FoundSurface> found_;  // of each row
};

}  // namespace weft::physics
