#include "scene/mesh/gltf_transform.h"

#include <algorithm>
#include <cmath>

namespace weft::text {

Quaternion slerp(const Quaternion& a, const Quaternion& b, double share) {
  double cosine = 0;
  for (std::size_t k = 0; k < 4; ++k) cosine += a[k] * b[k];
  const double angle = std::acos(std::min(std::abs(cosine), 1.0)), sine = std::sin(angle);
  const bool near = sine < 1e-7;  // a straight line is right to the last bit then
  const double from = near ? 1 - share : std::sin((1 - share) * angle) / sine;
  const double to = (near ? share : std::sin(share * angle) / sine) * (cosine < 0 ? -1 : 1);
  Quaternion q{};
  for (std::size_t k = 0; k < 4; ++k) q[k] = from * a[k] + to * b[k];
  return q;
}

Affine LocalTransform::affine() const {
  if (matrix) return *matrix;
  const auto [a, b, c, w] = rotation;
  const double s = 2 / (a * a + b * b + c * c + w * w);
  Affine p;
  p.columns = {{{1 - s * (b * b + c * c), s * (a * b + c * w), s * (a * c - b * w)},
                {s * (a * b - c * w), 1 - s * (a * a + c * c), s * (b * c + a * w)},
                {s * (a * c + b * w), s * (b * c - a * w), 1 - s * (a * a + b * b)}}};
  for (std::size_t n = 0; n < 3; ++n)
    for (double& value : p.columns[n]) value *= scale[n];
  p.translation = translation;
  return p;
}

}  // namespace weft::text
