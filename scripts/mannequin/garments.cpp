#include "garments.h"

#include <numbers>

namespace mannequin {
namespace {

constexpr double kShirtCell = 0.0125;               // m, of its triangles
constexpr double kNeck = 0.098, kHem = 0.84;        // m; radius about the neck, height of the hem
constexpr double kStraight = 0.96;                  // m; below it the shirt falls straight
constexpr double kSleeve = 0.7;                     // of the upper arm
constexpr int kAround = 132, kAlong = 64;           // squares of the skirt
constexpr double kWaist = 1.075, kSkirtHem = 0.55;  // m
constexpr double kOff = 0.004, kFlare = 0.3;        // m; m of radius for each m down

// The farthest that a shape reaches from the middle line at a height, in a direction [m].
double reach(const Field& shape, Vec out, double y) {
  double r = 0.4;
  for (int n = 0; n < 60 && r > 0.02; ++n) {
    const double d = shape({out.x * r, y, out.z * r});
    if (d < 1e-4) break;
    r -= d;
  }
  return r;
}

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

Mesh make_skirt(const Figure& figure) {
  const Field hips = [&](Vec p) { return figure.hips(p); };
  Mesh mesh;
  std::vector<double> radius(kAround, 0);
  for (int row = 0; row <= kAlong; ++row) {
    const double down = (kWaist - kSkirtHem) * row / kAlong, y = kWaist - down;
    for (int n = 0; n < kAround; ++n) {
      const double turn = 2 * std::numbers::pi * (n + 0.5 * (row % 2)) / kAround;
      const Vec out{std::sin(turn), 0, std::cos(turn)};
      double& r = radius[std::size_t(n)];
      const double step = row == 0 ? 0 : kFlare * (kWaist - kSkirtHem) / kAlong;
      r = std::max(r + step * smooth(0, 0.12, down), reach(hips, out, y) + kOff);
      mesh.vertices.push_back({out.x * r, y, out.z * r});
    }
  }
  const auto number = [](int row, int n) { return row * kAround + n % kAround; };
  for (int row = 0; row < kAlong; ++row)
    for (int n = 0; n < kAround; ++n) {
      const int a = number(row, n), b = number(row, n + 1), c = number(row + 1, n),
                d = number(row + 1, n + 1);
      if (row % 2 == 0) {
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({b, c, d});
      } else {
        mesh.triangles.push_back({a, c, d});
        mesh.triangles.push_back({a, d, b});
      }
    }
  return mesh;
}

}  // namespace mannequin
