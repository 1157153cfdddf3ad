// Whether a corner or an edge of a closed body has come through a triangle of cloth, and the way back.
#pragma once

#include "physics/contact/body/body_passage.h"
#include "physics/contact/triangle_shape.h"

namespace weft::physics {

// A point of the triangle that goes back so far that the feature lies on it.
struct Through {
  Weights weights{};
  Vec3 normal{};       // unit
  double depth = 0;    // m, along the normal; > 0: it may have come through
  double before = 0;   // m; how deep it was before the substep
  Vec3 way{};          // m; how far the feature has come there
  bool meets = false;  // the way back leads from the feature to the triangle, not past it
  // What lies right behind the feature, as the body sees it: a point of the triangle, and how far beside it is [m].
  Vec3 behind{};
  double beside = 0;
  Vec3 outward{};  // of the feature, unit
};

// Of a corner and the inner of a triangle. None where it is no deeper than `least` [m], which is not negative.
Through corner_through(const BodyPassage& body, const BodyForm::Feature& corner, const Corners& c,
                       double least);
// Of an edge and the side of a triangle from corner k on.
Through edge_through(const BodyPassage& body, const BodyForm::Feature& edge, const Corners& c,
                     std::size_t k, double least);

}  // namespace weft::physics
