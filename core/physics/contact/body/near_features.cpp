#include "physics/contact/body/near_features.h"

namespace weft::physics {

void NearFeatures::find(const BodyMoment& now, double time, const AlignedBox& about, double reach,
                        double most, int hint) {
  const BodyMoment begin = now.at_begin(), end = now.at_end();
  along_ = {now, time, hint};
  about_ = about;
  middle_ = times(plus(about.low, about.high), 0.5);
  reach_ = reach;
  most_ = most;
  features_.clear();
  for (std::vector<float>& row : boxes_) row.clear();
  const AlignedBox where = about.grown(reach);
  double extent = 0;
  now.features(
      most,
      [&](int node) {
        return along_.seen(begin.feature_box(node), end.feature_box(node)).meets(where);
      },
      [&](int n) {
        const BodyForm::Feature& f = now.form().features[std::size_t(n)];
        AlignedBox box;
        for (const int v : {f.a, f.b}) {
          box.add(along_.seen(begin.vertex(v), along_.begin()));
          box.add(along_.seen(end.vertex(v), along_.end()));
        }
        if (!box.meets(where)) return;
        features_.push_back(n);
        for (std::size_t k = 0; k < 3; ++k) {
          boxes_[k].push_back(float(box.low[k] - middle_[k]));
          boxes_[k + 3].push_back(float(box.high[k] - middle_[k]));
          extent = std::max({extent, middle_[k] - box.low[k], box.high[k] - middle_[k]});
        }
      });
  constexpr double kRounding = 4e-6;  // of the extent; 64 times that of one number
  const Vec3 size = minus(about.high, about.low);
  rounding_ = kRounding * (extent + reach + std::max({size[0], size[1], size[2]}));
  for (std::vector<float>& row : boxes_) row.resize(features_.size() + 16);
  some_.resize(features_.size() + 16);
  squares_.resize(some_.size());
}

bool NearFeatures::know(const AboutTriangle& triangle, double time) const {
  if (!along_.lasts(time) || triangle.most > most_) return false;
  const AlignedBox box = seen(triangle.box, time);
  const double left = reach_ - triangle.reach;
  for (std::size_t k = 0; k < 3; ++k)
    if (!(box.low[k] >= about_.low[k] - left && box.high[k] <= about_.high[k] + left)) return false;
  return true;
}

std::span<const int> NearFeatures::about(const SheetKernels& kernels, const AboutTriangle& triangle,
                                         double time) {
  if (features_.empty()) return {};
  NearBoxes boxes{};
  const AlignedBox box = seen(triangle.box, time);
  for (std::size_t k = 0; k < 3; ++k) {
    boxes.low[k] = boxes_[k].data();
    boxes.high[k] = boxes_[k + 3].data();
    boxes.box.low[k] = float(box.low[k] - middle_[k]);
    boxes.box.high[k] = float(box.high[k] - middle_[k]);
  }
  boxes.end = int(features_.size());
  const double distance = triangle.reach + rounding_;
  boxes.distance_squared = float(distance * distance);
  boxes.near = some_.data();
  boxes.square = squares_.data();
  const int count = kernels.near_boxes(boxes);
  const auto some = std::span(some_).first(std::size_t(count));
  for (int& n : some) n = features_[std::size_t(n)];
  return some;
}

std::size_t NearFeatures::bytes() const {
  std::size_t bytes =
      (features_.capacity() + some_.capacity()) * sizeof(int) + squares_.capacity() * sizeof(float);
  for (const std::vector<float>& row : boxes_) bytes += row.capacity() * sizeof(float);
  return bytes;
}

}  // namespace weft::physics
