#include "garments.h"

namespace mannequin {
namespace {

constexpr double kShirtCell = 0.0125;         // m, of its triangles
constexpr double kNeck = 0.098, kHem = 0.84;  // m; radius about the neck, height of the hem
constexpr double kStraight = 0.96;            // m; below it the shirt falls straight
constexpr double kSleeve = 0.7;               // of the upper arm

}  // namespace

Mesh make_shirt(const Figure& figure) {
  // Wide about the trunk below the chest, as shirts fall from there, and about the arms.
  const Field off = [&](Vec p) {
    const double low = smooth(1.3, 1.0, p.y), arm = smooth(0.17, 0.26, std::abs(p.x));
    return figure.sleeves({p.x, std::max(p.y, kStraight), p.z}) -
           (0.009 + 0.018 * low + 0.012 * arm);
  };
  const Joints& j = figure.joints();
  const Vec arm = unit(j.elbow - j.shoulder);
  const double sleeve = kSleeve * length(j.elbow - j.shoulder);
  const Field kept = [&](Vec p) {
    const Vec q{std::abs(p.x), p.y, p.z};
    const double neck = std::min(kNeck - length({p.x, 0, p.z + 0.022}), p.y - 1.418 + 0.35 * p.z),
                 hem = kHem - p.y;
    const double cuff = q.x > 0.2 && p.y > 1.1 ? dot(q - j.shoulder, arm) - sleeve : -1;
    return std::max({neck, hem, cuff});
  };
  return cut(surface_of(off, {-0.6, 0.6, -0.3}, {0.6, 1.62, 0.35}, kShirtCell), off, kept);
}

}  // namespace mannequin
