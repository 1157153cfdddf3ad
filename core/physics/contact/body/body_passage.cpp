#include "physics/contact/body/body_passage.h"

#include <cmath>

#include "physics/contact/body/meeting.h"

namespace weft::physics {

// What passes an edge is not to be lost, and of two triangles that a path meets at once the first counts.
BodyPassage::Hit BodyPassage::first_on(const Vec3& from, const Vec3& to) const {
  AlignedBox box;
  box.add(from);
  box.add(to);
  double first = 2;
  Hit hit;
  now.swept(before, box, [&](int n) {
    const Triangle end = now.corners(n);
    const Met met = moves() ? meets_moving(from, to, before.corners(n), end) : meets(from, to, end);
    if (met.at > first || (met.at == first && n > hit.triangle)) return;
    first = met.at;
    hit = {n, met.weights};
  });
  return first > 1 ? Hit{} : hit;
}

// What is only pressed into the surface sees the same side from both ends of its path. What rests on the surface lies in
// it to rounding, and enters there all the same.
BodyPassage::Point BodyPassage::entered_at(const Vec3& from, const Vec3& to, const Point& was,
                                           const Point& is) const {
  constexpr double kSameSide = 0.5;  // cosine
  if (dot(was.normal, is.normal) > kSameSide) return is;
  constexpr double kResting =
      1e-5;  // m; rounding of positions, within 8 m of zero, many times over
  const bool rests = std::abs(was.distance) < kResting;
  const Vec3 outside = rests ? plus(from, times(was.normal, kResting - was.distance)) : from;
  const Hit hit = first_on(outside, to);
  if (hit.triangle < 0) return is;
  const Vec3 n = now.face_normal(hit.triangle);
  const double beyond = dot(minus(to, now.on(hit.triangle, hit.weights)), n);
  return beyond < 0 ? Point{beyond, n, hit.triangle, hit.weights} : is;
}

BodyPassage::Point BodyPassage::on_side_of(const Vec3& from, const Vec3& to,
                                           const Point& is) const {
  constexpr double kSameSheet = 0.5;  // cosine
  const Hit hit = first_on(from, to);
  if (hit.triangle < 0) return is;
  const Vec3 n = now.face_normal(hit.triangle);
  const Vec3 path = minus(minus(to, from), way(hit.triangle, hit.weights));
  const Vec3 back = times(n, dot(path, n) > 0 ? -1 : 1);  // to where it was
  if (dot(is.normal, back) < -kSameSheet)
    return {-is.distance, times(is.normal, -1), is.triangle, is.weights};
  return {dot(minus(to, now.on(hit.triangle, hit.weights)), back), back, hit.triangle, hit.weights};
}

}  // namespace weft::physics
