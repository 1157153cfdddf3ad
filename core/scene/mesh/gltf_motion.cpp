#include "scene/mesh/gltf_motion.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "scene/mesh/faces.h"
#include "scene/mesh/gltf_curve.h"
#include "scene/mesh/sampled_motion.h"

namespace weft::text {
namespace {

// Straight ways between samples come no farther from the file's motion than this share of the mesh's size: a tenth of
// a millimetre of a body of a man's size, less than cloth is thick. A turn takes 220 samples.
constexpr double kTolerance = 1e-4;
// Half an hour of 60 a second, or all keys of a channel that steps.
constexpr std::size_t kMostSamples = std::size_t{1} << 17;
// Of work() in all poses that are looked at, ten for each sample: about half a minute. A body of 40 000 vertices with
// four joints each may have 8000 samples.
constexpr std::size_t kMostWork = std::size_t{1} << 34;

// Of all samplers: the weights of one export, twice.
constexpr std::size_t kMostNumbers = std::size_t{1} << 25;

enum class Path { translation, rotation, scale, weights };
constexpr const char* kPaths[] = {"translation", "rotation", "scale", "weights"};

struct Channel {
  std::size_t node;  // among those that are shown
  Path path;
  std::size_t curve;  // in the list of them
};

class Animation {
 public:
  Animation(const GltfValue& document, GltfData& data, const GltfNodes& nodes,
            const std::vector<GltfFigure>& figures, const GltfPose& at_rest)
      : data_(data),
        nodes_(nodes),
        figures_(figures),
        at_rest_(at_rest),
        animations_(list_of(document)),
        played_(animations_.item(0)) {
    const GltfValue channels = played_.at("channels");
    for (std::size_t n = 0; n < channels.size(); ++n) read(channels.item(n));
  }

  GltfMotion sample() const {
    GltfMotion motion;
    const auto at = [&](double time) { return vertices(pose(time)); };
    std::vector<double> knots;
    for (const GltfCurve& curve : curves_)
      knots.insert(knots.end(), curve.knots().begin(), curve.knots().end());
    if (knots.empty()) knots.push_back(0);
    const Places first = at(*std::min_element(knots.begin(), knots.end()));
    const double size = size_of(first);
    const std::size_t most = most_samples(first.size());
    const SampledMotion chosen = choose_samples(knots, kTolerance * size, most, at);
    if (chosen.times.size() > most)
      played_.refuse("the animation has keys at " + std::to_string(chosen.times.size()) + " times",
                     std::to_string(most) + ", for so many vertices and nodes");
    motion.cache.points = int(first.size());
    motion.cache.times = chosen.times;
    motion.cache.places.reserve(first.size() * chosen.times.size());
    for (const float time : chosen.times)
      for (const Vec3& p : at(double(time)))
        motion.cache.places.push_back({float(p[0]), float(p[1]), float(p[2])});
    tell(motion, chosen, size);
    return motion;
  }

 private:
  using Places = std::vector<Vec3>;

  static GltfValue list_of(const GltfValue& document) {
    const auto list = document.find("animations");
    if (!list || list->size() == 0)
      document.refuse("the file has no animation", "one of nodes, skins or morph targets");
    return *list;
  }

  // Channels of what is not shown, or of what only extensions know, move no vertex.
  void read(const GltfValue& channel) {
    const GltfValue target = channel.at("target");
    const auto number = target.find("node");
    const auto path = std::find(std::begin(kPaths), std::end(kPaths), target.at("path").words());
    if (!number || path == std::end(kPaths)) return;
    const auto node = nodes_.find(number->whole(kMostGltfItems));
    if (!node) return;
    Channel read{*node, Path(path - std::begin(kPaths)), 0};
    std::size_t width = read.path == Path::rotation ? 4 : 3;
    if (read.path == Path::weights) width = at_rest_.weights[*node].size();
    if (width == 0) return;
    if (read.path != Path::weights && nodes_.shown()[*node].at_rest.matrix)
      target.at("node").refuse("the node has a matrix", "translation, rotation and scale");
    if (!moved_.insert({*node, read.path}).second)
      target.refuse("the node's " + std::string(*path) + " has a channel already", "one");
    const GltfValue samplers = played_.at("samplers");
    const std::size_t sampler = channel.at("sampler").whole(kMostGltfItems);
    const auto [known, fresh] = curve_of_.try_emplace({sampler, read.path, width}, curves_.size());
    if (fresh)
      curves_.emplace_back(
          samplers.item(sampler), data_,
          read.path == Path::weights    ? "SCALAR"
          : read.path == Path::rotation ? "VEC4"
                                        : "VEC3",
          width,
          read.path == Path::rotation ? GltfCurve::Kind::rotation : GltfCurve::Kind::numbers);
    read.curve = known->second;
    numbers_ += fresh ? curves_.back().size() : 0;
    if (numbers_ > kMostNumbers)
      played_.refuse("the samplers have more values", std::to_string(kMostNumbers) + " of all");
    channels_.push_back(read);
  }

  GltfPose pose(double time) const {
    std::vector<LocalTransform> locals = nodes_.at_rest();
    GltfPose pose{{}, at_rest_.weights};
    for (const Channel& channel : channels_) {
      LocalTransform& local = locals[channel.node];
      const std::span<double> values[] = {local.translation, local.rotation, local.scale,
                                          pose.weights[channel.node]};
      curves_[channel.curve].at(time, values[std::size_t(channel.path)]);
    }
    pose.places = nodes_.places(locals);
    return pose;
  }

  Places vertices(const GltfPose& pose) const {
    Places all;
    for (const GltfFigure& figure : figures_) {
      const Places own = figure.vertices(pose);
      all.insert(all.end(), own.begin(), own.end());
    }
    return all;
  }

  static double size_of(const Places& places) {
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax_element(
          places.begin(), places.end(), [k](const Vec3& a, const Vec3& b) { return a[k] < b[k]; });
      most = std::max(most, (*high)[k] - (*low)[k]);
    }
    return most;
  }

  std::size_t most_samples(std::size_t points) const {
    const std::size_t by_memory = kMaxMeshBytes / (sizeof(PointCache::Place) * points);
    constexpr std::size_t kPoses = 10, kNode = 64;  // its values are copied and turned into a place
    std::size_t work = kNode * nodes_.shown().size();
    for (const GltfFigure& figure : figures_) work += figure.work();
    const std::size_t by_work = kMostWork / (kPoses * work);
    return std::max<std::size_t>(1, std::min({kMostSamples, by_memory, by_work}));
  }

  void tell(GltfMotion& motion, const SampledMotion& chosen, double size) const {
    if (animations_.size() > 1) {
      std::string others;
      for (std::size_t n = 1; n < std::min<std::size_t>(animations_.size(), 10); ++n)
        others += (n > 1 ? ", " : "") + name_of(n);
      motion.notes.push_back(
          "of " + std::to_string(animations_.size()) + " animations the first, " + name_of(0) +
          ", is played; the others: " + others + (animations_.size() > 10 ? ", …" : ""));
    }
    if (std::any_of(curves_.begin(), curves_.end(), [](const auto& c) { return c.steps(); }))
      motion.notes.push_back("values that jump from key to key do so within 1/60 s before a key");
    if (chosen.off > kTolerance * size)
      motion.notes.push_back("the body comes as far as " + number_words(chosen.off) +
                             " from the file's motion, in its units: more samples do not fit, or "
                             "it is faster than 1e-4 s");
    const PointCache& cache = motion.cache;
    const auto stands = [&](int n) {
      return std::equal(cache.sample(n), cache.sample(n) + cache.points, cache.sample(0));
    };
    for (int n = 0; n < cache.samples(); ++n)
      if (!stands(n)) return;
    motion.notes.push_back("the animation " + name_of(0) + " moves no vertex");
  }

  std::string name_of(std::size_t n) const {
    return brief(Json(animations_.item(n).words_or("name", std::to_string(n).c_str())));
  }

  GltfData& data_;
  const GltfNodes& nodes_;
  const std::vector<GltfFigure>& figures_;
  const GltfPose& at_rest_;
  GltfValue animations_, played_;
  std::vector<GltfCurve> curves_;
  std::map<std::tuple<std::size_t, Path, std::size_t>, std::size_t> curve_of_;
  std::set<std::pair<std::size_t, Path>> moved_;  // nodes that have a channel
  std::vector<Channel> channels_;
  std::size_t numbers_ = 0;  // of the curves
};

}  // namespace

GltfMotion motion_of(const GltfValue& document, GltfData& data, const GltfNodes& nodes,
                     const std::vector<GltfFigure>& figures, const GltfPose& at_rest) {
  return Animation(document, data, nodes, figures, at_rest).sample();
}

}  // namespace weft::text
