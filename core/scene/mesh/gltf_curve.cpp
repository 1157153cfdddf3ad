#include "scene/mesh/gltf_curve.h"

#include <algorithm>
#include <cmath>

#include "scene/mesh/gltf_nodes.h"

namespace weft::text {
namespace {

constexpr double kLatest = 1e6;             // s
constexpr std::size_t kMostKeys = 1 << 16;  // 18 minutes of 60 a second
constexpr std::size_t kMostValues = std::size_t{1}
                                    << 25;  // weights of as many samples as are exported

// Divides a quaternion by its length; one of no length is the identity.
void normalise(std::span<double> q) {
  double square = 0;
  for (const double value : q) square += value * value;
  const double length = std::sqrt(square);
  for (std::size_t k = 0; k < q.size(); ++k)
    q[k] = length > 1e-12 ? q[k] / length : (k == 3 ? 1.0 : 0.0);
}

}  // namespace

GltfCurve::GltfCurve(const GltfValue& sampler, GltfData& data, const char* type, std::size_t width,
                     Kind kind)
    : width_(width), kind_(kind), way_(way_of(sampler)) {
  const GltfValue input = sampler.at("input"), output = sampler.at("output");
  const std::size_t inputs = input.whole(kMostGltfItems), outputs = output.whole(kMostGltfItems);
  data.count(inputs, kMostKeys);
  times_ = data.numbers(inputs, "SCALAR");
  if (times_.empty()) input.refuse("there are no times", "one at least");
  for (std::size_t n = 0; n < times_.size(); ++n) {
    const std::string time = "time " + std::to_string(n) + " is " + number_words(times_[n]);
    if (!(times_[n] >= 0 && times_[n] <= kLatest)) input.refuse(time, "0 to 1e6");
    if (n > 0 && times_[n] <= times_[n - 1])
      input.refuse(time + ", and the one before it is no earlier", "times that increase");
  }
  const std::size_t parts = way_ == Way::cubic ? 3 : 1;
  const std::size_t elements = times_.size() * parts * (type[0] == 'S' ? width : 1);
  if (const std::size_t given = data.count(outputs, kMostValues); given != elements)
    output.refuse("there are " + std::to_string(given) + " values",
                  std::to_string(elements) + ", by the times");
  for (const double number : data.numbers(outputs, type)) values_.push_back(float(number));
  for (std::size_t key = 0; kind_ == Kind::rotation && key < times_.size(); ++key) {
    const float* q = value(key);
    if (!is_rotation({double(q[0]), double(q[1]), double(q[2]), double(q[3])}))
      output.refuse("the quaternion of key " + std::to_string(key) + " is no rotation",
                    "unit quaternions");
  }
  for (std::size_t key = 0; key < times_.size(); ++key) {
    if (steps() && key > 0) knots_.push_back(step_begin(key));
    knots_.push_back(times_[key]);
  }
}

GltfCurve::Way GltfCurve::way_of(const GltfValue& sampler) {
  const std::string way = sampler.words_or("interpolation", "LINEAR");
  if (way == "STEP") return Way::step;
  if (way == "LINEAR") return Way::linear;
  if (way != "CUBICSPLINE")
    sampler.at("interpolation")
        .refuse(brief(Json(way)) + " is out of place", "STEP, LINEAR, CUBICSPLINE");
  return Way::cubic;
}

double GltfCurve::step_begin(std::size_t key) const {
  return std::max(times_[key] - kStepTime, (times_[key - 1] + times_[key]) / 2);
}

void GltfCurve::at(double time, std::span<double> value) const {
  const std::size_t after =
      std::size_t(std::upper_bound(times_.begin(), times_.end(), time) - times_.begin());
  if (after == 0) return blend(0, 0, value);
  const std::size_t key = after - 1;
  if (after == times_.size()) return blend(key, 0, value);
  const double begin = way_ == Way::step ? step_begin(after) : times_[key];
  const double share = std::max(0.0, (time - begin) / (times_[after] - begin));
  way_ == Way::cubic ? spline(key, share, value) : blend(key, share, value);
}

void GltfCurve::blend(std::size_t key, double share, std::span<double> value) const {
  const float *from = this->value(key), *to = share > 0 ? this->value(key + 1) : from;
  if (kind_ == Kind::rotation) {
    Quaternion a{}, b{};
    std::copy_n(from, 4, a.begin());
    std::copy_n(to, 4, b.begin());
    normalise(a);
    normalise(b);
    const Quaternion q = slerp(a, b, share);
    std::copy(q.begin(), q.end(), value.begin());
    return;
  }
  for (std::size_t k = 0; k < width_; ++k)
    value[k] = share > 0 ? (1 - share) * double(from[k]) + share * double(to[k]) : double(from[k]);
}

// Hermite's cubic, whose tangents are per second.
void GltfCurve::spline(std::size_t key, double share, std::span<double> value) const {
  const double t = share, length = times_[key + 1] - times_[key];
  const double from = (2 * t - 3) * t * t + 1, leaving = length * ((t - 2) * t + 1) * t;
  const double to = (3 - 2 * t) * t * t, coming = length * (t - 1) * t * t;
  const float *a = this->value(key), *b = this->value(key + 1);
  const float *out = numbers(key, 2), *in = numbers(key + 1, 0);
  for (std::size_t k = 0; k < width_; ++k)
    value[k] =
        from * double(a[k]) + leaving * double(out[k]) + to * double(b[k]) + coming * double(in[k]);
  if (kind_ == Kind::rotation) normalise(value);
}

}  // namespace weft::text
