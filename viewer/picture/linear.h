// Vectors and matrices as OpenGL takes them: floats, matrices column after column.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "weft/scene.h"

namespace weft::viewer {

struct Vec3f {
  float x = 0, y = 0, z = 0;
  friend bool operator==(const Vec3f&, const Vec3f&) = default;
};

inline Vec3f operator+(Vec3f a, Vec3f b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3f operator-(Vec3f a, Vec3f b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3f operator-(Vec3f a) {
  return {-a.x, -a.y, -a.z};
}
inline Vec3f operator*(Vec3f a, float s) {
  return {a.x * s, a.y * s, a.z * s};
}
inline Vec3f operator*(float s, Vec3f a) {
  return a * s;
}
inline float dot(Vec3f a, Vec3f b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3f cross(Vec3f a, Vec3f b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(Vec3f a) {
  return std::sqrt(dot(a, a));
}
inline Vec3f normalized(Vec3f a) {
  const float l = length(a);
  return l > 0 ? a * (1 / l) : Vec3f{0, 1, 0};
}
inline Vec3f mix(Vec3f a, Vec3f b, float t) {
  return a + (b - a) * t;
}
inline Vec3f to_float(const Vec3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
inline Vec3 to_double(Vec3f v) {
  return {v.x, v.y, v.z};
}

// A unit vector at right angles to the unit vector n.
inline Vec3f any_normal(Vec3f n) {
  return normalized(cross(n, std::abs(n.y) < 0.9f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0}));
}

struct Mat4 {
  std::array<float, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};

inline Mat4 operator*(const Mat4& a, const Mat4& b) {
  Mat4 c;
  for (std::size_t col = 0; col < 4; ++col)
    for (std::size_t row = 0; row < 4; ++row) {
      float sum = 0;
      for (std::size_t k = 0; k < 4; ++k) sum += a.m[k * 4 + row] * b.m[col * 4 + k];
      c.m[col * 4 + row] = sum;
    }
  return c;
}

// The frame with the given axes and origin.
inline Mat4 frame_matrix(Vec3f x, Vec3f y, Vec3f z, Vec3f origin) {
  return {{x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1}};
}

inline Mat4 look_at(Vec3f eye, Vec3f target, Vec3f up) {
  const Vec3f f = normalized(target - eye);
  const Vec3f s = normalized(cross(f, up));
  const Vec3f u = cross(s, f);
  return {{s.x, u.x, -f.x, 0, s.y, u.y, -f.y, 0, s.z, u.z, -f.z, 0, -dot(s, eye), -dot(u, eye),
           dot(f, eye), 1}};
}

// `fov`: the angle from bottom to top [rad].
inline Mat4 perspective(float fov, float aspect, float near, float far) {
  const float f = 1 / std::tan(fov / 2);
  return {{f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0,
           2 * far * near / (near - far), 0}};
}

// The box of half-sizes (x, y) and depths 0 … far before the eye.
inline Mat4 orthographic(float x, float y, float far) {
  return {{1 / x, 0, 0, 0, 0, 1 / y, 0, 0, 0, 0, -2 / far, 0, 0, 0, -1, 1}};
}

// An axis-aligned box, empty at first.
struct Bounds {
  Vec3f low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};

  bool empty() const { return low.x > high.x; }
  void add(Vec3f p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  void add(const Bounds& other) {
    if (other.empty()) return;
    add(other.low);
    add(other.high);
  }
  void add_ball(Vec3f center, float radius) {
    add(center - Vec3f{radius, radius, radius});
    add(center + Vec3f{radius, radius, radius});
  }
  Vec3f center() const { return (low + high) * 0.5f; }
  float radius() const { return empty() ? 1 : length(high - low) * 0.5f; }
};

}  // namespace weft::viewer
