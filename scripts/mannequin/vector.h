// Arithmetic of vectors and rotations.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace mannequin {

struct Vec {
  double x = 0, y = 0, z = 0;
};
inline Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec operator-(Vec a, Vec b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec operator*(Vec a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
inline double dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec a) {
  return std::sqrt(dot(a, a));
}
inline Vec unit(Vec a) {
  return a * (1 / std::max(length(a), 1e-12));
}
inline Vec mirrored(Vec a) {
  return {-a.x, a.y, a.z};
}
inline Vec mixed(Vec a, Vec b, double share) {
  return a * (1 - share) + b * share;
}
// From 0 to 1 while t goes from `from` to `to`, without a kink.
inline double smooth(double from, double to, double t) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

// By its columns.
struct Rotation {
  Vec a{1, 0, 0}, b{0, 1, 0}, c{0, 0, 1};
};
inline Vec operator*(const Rotation& r, Vec v) {
  return r.a * v.x + r.b * v.y + r.c * v.z;
}
inline Rotation operator*(const Rotation& r, const Rotation& s) {
  return {r * s.a, r * s.b, r * s.c};
}
inline Rotation transposed(const Rotation& r) {
  return {{r.a.x, r.b.x, r.c.x}, {r.a.y, r.b.y, r.c.y}, {r.a.z, r.b.z, r.c.z}};
}
// About x, y, z by so many radians.
inline Rotation about_x(double t) {
  return {{1, 0, 0}, {0, std::cos(t), std::sin(t)}, {0, -std::sin(t), std::cos(t)}};
}
inline Rotation about_y(double t) {
  return {{std::cos(t), 0, -std::sin(t)}, {0, 1, 0}, {std::sin(t), 0, std::cos(t)}};
}
inline Rotation about_z(double t) {
  return {{std::cos(t), std::sin(t), 0}, {-std::sin(t), std::cos(t), 0}, {0, 0, 1}};
}
// Its second axis along a limb, its third as far as possible along `forward`.
inline Rotation along(Vec limb, Vec forward) {
  const Vec b = unit(limb), a = unit(cross(b, forward));
  return {a, b, cross(a, b)};
}

}  // namespace mannequin
