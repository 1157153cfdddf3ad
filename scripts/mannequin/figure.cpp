#include "figure.h"

namespace mannequin {
namespace {

constexpr double kTrunk = 0.05, kLimb = 0.008;  // m; how far parts blend

}  // namespace

double distance(const Cone& cone, Vec p) {
  const Vec axis = cone.b - cone.a;
  const double square = dot(axis, axis), drop = cone.ra - cone.rb;
  const double along = square > 0 ? dot(p - cone.a, axis) / square : 0;
  const double across = length(p - cone.a - axis * along), reach = std::sqrt(std::max(square, 0.0));
  // The nearest point of the axis lies further towards the thin end where the sides are inclined.
  const double lean = square > drop * drop ? drop / std::sqrt(square - drop * drop) : 0;
  const double t = std::clamp(along + (reach > 0 ? across * -lean / reach : 0.0), 0.0, 1.0);
  return length(p - cone.a - axis * t) - (cone.ra + (cone.rb - cone.ra) * t);
}

double blended(double a, double b, double by) {
  const double h = std::max(by - std::abs(a - b), 0.0) / by;
  return std::min(a, b) - h * h * by / 4;
}

// Cones of one bone lie together.
void Figure::add(const Cone& cone) {
  const auto after = std::find_if(cones_.rbegin(), cones_.rend(),
                                  [&](const Cone& other) { return other.of == cone.of; });
  cones_.insert(after == cones_.rend() ? cones_.end() : after.base(), cone);
}

Figure::Group Figure::at(Bone bone, int side) const {
  const auto is = [&](const Cone& cone) { return cone.of == BoneOf{bone, side}; };
  const auto first = std::find_if(cones_.begin(), cones_.end(), is);
  return {first, std::find_if_not(first, cones_.end(), is)};
}

Figure::Figure() {
  const Joints& j = joints_;
  const auto middle = [&](Bone bone, Vec a, Vec b, double ra, double rb) {
    add({{bone, 0}, a, b, ra, rb});
  };
  const auto both = [&](Bone bone, Vec a, Vec b, double ra, double rb) {
    add({{bone, 1}, a, b, ra, rb});
    add({{bone, -1}, mirrored(a), mirrored(b), ra, rb});
  };
  // Wide parts of the trunk lie across.
  const auto across = [&](Bone bone, double half, double y, double z, double r) {
    middle(bone, {-half, y, z}, {half, y, z}, r, r);
  };
  across(Bone::pelvis, 0.078, 0.945, 0.0, 0.094);
  middle(Bone::pelvis, {-0.072, 0.92, -0.042}, {0.072, 0.92, -0.042}, 0.08, 0.08);
  across(Bone::pelvis, 0.066, 1.02, 0.0, 0.088);
  across(Bone::waist, 0.053, 1.09, 0.004, 0.084);
  across(Bone::waist, 0.055, 1.16, 0.004, 0.086);
  across(Bone::chest, 0.064, 1.24, 0.0, 0.092);
  across(Bone::chest, 0.075, 1.32, -0.008, 0.09);
  across(Bone::chest, 0.11, 1.385, -0.015, 0.062);
  middle(Bone::chest, {-0.062, 1.29, 0.045}, {0.062, 1.29, 0.045}, 0.055, 0.055);
  both(Bone::chest, {0.03, 1.465, -0.022}, {0.14, 1.42, -0.015}, 0.042, 0.042);
  middle(Bone::neck, {0, 1.42, -0.025}, {0, 1.53, -0.008}, 0.062, 0.05);
  middle(Bone::head, {0, 1.61, -0.012}, {0, 1.655, -0.006}, 0.085, 0.082);
  middle(Bone::head, {0, 1.553, 0.045}, {0, 1.62, 0.038}, 0.042, 0.062);
  both(Bone::upper_arm, j.shoulder, j.elbow, 0.056, 0.04);
  both(Bone::forearm, j.elbow, mixed(j.elbow, j.wrist, 0.3), 0.039, 0.041);
  both(Bone::forearm, mixed(j.elbow, j.wrist, 0.3), j.wrist, 0.041, 0.027);
  const Vec hand = unit(j.wrist - j.elbow), palm = j.wrist + hand * 0.07;
  both(Bone::hand, j.wrist, palm + Vec{0, 0, 0.012}, 0.026, 0.029);
  both(Bone::hand, j.wrist, palm + Vec{0, 0, -0.014}, 0.026, 0.026);
  both(Bone::hand, palm + Vec{0, 0, 0.01}, palm + hand * 0.085 + Vec{-0.015, 0, 0.012}, 0.026,
       0.016);
  both(Bone::hand, palm + Vec{0, 0, -0.012}, palm + hand * 0.07 + Vec{-0.015, 0, -0.008}, 0.024,
       0.015);
  both(Bone::hand, j.wrist + hand * 0.03 + Vec{0, 0, 0.02},
       palm + hand * 0.02 + Vec{-0.012, 0, 0.05}, 0.02, 0.015);
  both(Bone::thigh, j.hip + Vec{0.004, -0.02, 0}, j.knee, 0.083, 0.053);
  both(Bone::shin, j.knee, j.knee + Vec{0.005, -0.13, -0.02}, 0.051, 0.055);
  both(Bone::shin, j.knee + Vec{0.005, -0.13, -0.02}, j.ankle, 0.055, 0.035);
  both(Bone::foot, {j.ankle.x, 0.06, -0.02}, {j.heel.x, 0.036, j.heel.z}, 0.038, 0.036);
  both(Bone::foot, {j.ankle.x, 0.055, 0.0}, {j.ball.x, 0.034, j.ball.z}, 0.042, 0.034);
  both(Bone::foot, {j.ball.x - 0.018, 0.03, j.ball.z}, {j.ball.x - 0.012, 0.024, j.ball.z + 0.062},
       0.03, 0.023);
  both(Bone::foot, {j.ball.x + 0.015, 0.028, j.ball.z - 0.01},
       {j.ball.x + 0.015, 0.022, j.ball.z + 0.04}, 0.027, 0.02);
}

double Figure::of(Vec p, std::initializer_list<Group> groups, double by) const {
  double d = 1e3;
  for (const Group group : groups)
    for (const Cone& cone : group) d = blended(d, distance(cone, p), by);
  return d;
}

double Figure::trunk(Vec p) const {
  return of(p,
            {at(Bone::pelvis), at(Bone::waist), at(Bone::chest), at(Bone::chest, 1),
             at(Bone::chest, -1), at(Bone::neck)},
            kTrunk);
}

double Figure::sleeves(Vec p) const {
  double d = trunk(p);
  for (const int side : {-1, 1})
    d = blended(d, of(p, {at(Bone::upper_arm, side), at(Bone::forearm, side)}, kLimb), 0.05);
  return d;
}

double Figure::body(Vec p) const {
  double d = blended(trunk(p), of(p, {at(Bone::head)}, 0.05), 0.02);
  for (const int side : {-1, 1}) {
    const double arm = of(p, {at(Bone::upper_arm, side), at(Bone::forearm, side)}, kLimb);
    d = blended(d, blended(arm, of(p, {at(Bone::hand, side)}, 0.015), 0.01), 0.03);
    const double leg = of(p, {at(Bone::thigh, side), at(Bone::shin, side)}, kLimb);
    d = blended(d, blended(leg, of(p, {at(Bone::foot, side)}, 0.02), 0.02), 0.03);
  }
  return d;
}

}  // namespace mannequin
