// A triangle of cloth against the edges and corners of a body that is a mesh.
#pragma once

#include "physics/contact/body/body_passage.h"
#include "physics/contact/triangle_shape.h"

namespace weft::physics {

// The point of a triangle deepest in the body, of those that are nearest to a corner or an edge of the body
// that sticks out by less than the triangle is large: one that is round in comparison leaves the triangle
// hardly deeper than its corners, which particles are. A point inside of the body that was outside before
// the substep, or hardly in it, goes back over the edge or corner that has come through; others go the
// nearest way out. `edge` [m]: the longest of a flat triangle; no point is deep: distance is `offset`.
struct DeepestOnBody : Deepest {
  Vec3 way{};  // m; how far the surface there has come
};
DeepestOnBody deepest_on(const BodyPassage& body, const Corners& c, double offset, double edge);
// What of a body that may be about.
struct AboutTriangle {
  AlignedBox box;    // of the triangle
  double reach = 0;  // m, from there
  double most = 0;   // m; greater radii are of no account
};
AboutTriangle about_triangle(const BodyPassage& body, const Corners& c, double offset, double edge);
// Among these features, by the order of their tree.
DeepestOnBody deepest_among(std::span<const int> features, const BodyPassage& body,
                            const Corners& c, double offset, double edge);
// Of one that stands.
Deepest deepest_on(const MeshBody& body, const Corners& c, double offset, double edge,
                   double tolerance = kExact);

}  // namespace weft::physics
