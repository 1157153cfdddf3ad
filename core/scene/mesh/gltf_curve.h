// One sampler of a glTF animation: a value over time.
#pragma once

#include <span>
#include <vector>

#include "scene/mesh/gltf_data.h"

namespace weft::text {

class GltfCurve {
 public:
  enum class Kind { numbers, rotation };

  // `width`: numbers of a value; `type`: of the accessor that lists them, which has one element a value, or one a
  // number ("SCALAR"). Refused: times that do not increase or lie beyond 1e6 s, another number of values than of
  // times, quaternions that are no rotations.
  GltfCurve(const GltfValue& sampler, GltfData& data, const char* type, std::size_t width,
            Kind kind);

  // Where it does not run smoothly [s]: its keys, and where steps begin.
  const std::vector<double>& knots() const { return knots_; }
  // How many numbers it keeps.
  std::size_t size() const { return values_.size(); }
  bool steps() const { return way_ == Way::step && times_.size() > 1; }
  // The value at a time, held before the first key and after the last.
  void at(double time, std::span<double> value) const;

  // How long a step takes, ending at its key, or half of what lies between two keys: bodies that jump would be
  // where cloth is without having come there. A frame, as a step between two frames is seen [s].
  static constexpr double kStepTime = 1.0 / 60;

 private:
  enum class Way { step, linear, cubic };
  static Way way_of(const GltfValue& sampler);
  double step_begin(std::size_t key) const;
  // The numbers of a key: its value, or a tangent before (0) or after it (2).
  const float* numbers(std::size_t key, std::size_t part) const {
    return values_.data() + (way_ == Way::cubic ? 3 * key + part : key) * width_;
  }
  const float* value(std::size_t key) const { return numbers(key, 1); }
  void blend(std::size_t key, double share, std::span<double> value) const;
  void spline(std::size_t key, double share, std::span<double> value) const;

  std::size_t width_;
  Kind kind_;
  Way way_;
  std::vector<double> times_, knots_;
  std::vector<float> values_;
};

}  // namespace weft::text
