#include "skin.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace mannequin {
namespace {

constexpr double kWide = 0.016;  // m; how far a bone has a part in what belongs to another
constexpr int kRounds = 14;      // of smoothing over the mesh

}  // namespace

Skin::Skin(const Figure& figure, const Mesh& mesh) : figure_(figure), mesh_(mesh) {
  for (const auto& [bone, pose] : pose_at(figure.joints(), 0).bones) bones_.push_back(bone);
  // Shoulders are cones of either side, of a bone in the middle.
  const auto number = [&](BoneOf bone) {
    const auto own = std::find(bones_.begin(), bones_.end(), bone);
    const auto found =
        own != bones_.end() ? own : std::find(bones_.begin(), bones_.end(), BoneOf{bone.bone, 0});
    if (found == bones_.end()) throw std::logic_error("a cone of the figure has no bone");
    return std::size_t(found - bones_.begin());
  };
  for (const Vec& p : mesh.vertices) {
    Weights distances(bones_.size(), 1.0), weights;
    for (const Cone& cone : figure.cones()) {
      double& least = distances[number(cone.of)];
      least = std::min(least, std::max(0.0, distance(cone, p)));
    }
    double sum = 0;
    for (const double d : distances) sum += weights.emplace_back(std::exp(-d / kWide));
    for (double& w : weights) w /= sum;
    weights_.push_back(std::move(weights));
  }
  std::vector<std::set<int>> beside(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
    for (const int a : t) beside[std::size_t(a)].insert(t.begin(), t.end());
  for (int n = 0; n < kRounds; ++n) {
    std::vector<Weights> next(weights_.size(), Weights(bones_.size()));
    for (std::size_t v = 0; v < next.size(); ++v)
      for (const int other : beside[v])
        for (std::size_t b = 0; b < bones_.size(); ++b)
          next[v][b] += weights_[std::size_t(other)][b] / double(beside[v].size());
    weights_ = std::move(next);
  }
}

std::vector<Vec> Skin::at(double time) const {
  const Body body = pose_at(figure_.joints(), time);
  std::vector<Vec> x(mesh_.vertices.size());
  for (std::size_t v = 0; v < x.size(); ++v)
    for (std::size_t b = 0; b < bones_.size(); ++b)
      if (const double w = weights_[v][b]; w > 1e-6)
        x[v] = x[v] + body.bones[b].second(mesh_.vertices[v]) * w;
  return x;
}

}  // namespace mannequin
