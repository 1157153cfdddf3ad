#include "scene/mesh/gltf_figure.h"

#include <algorithm>
#include <cmath>

#include "scene/mesh/faces.h"
#include "scene/mesh/welding.h"

namespace weft::text {
namespace {

// Vertices in one place are one where no pose parts them by more than this share of the mesh's size: a gap that
// cloth, which is about as thick, does not find. Copies that exporters make have the same numbers; lips that meet
// where a face rests do not.
constexpr double kSameShare = 1e-3;
// A sum of weights that is as far from 1 as rounding to bytes makes it is no mistake.
constexpr double kRoundedSum = 0.01;

std::string set_name(const char* kind, std::size_t set) {
  return kind + std::to_string(set);
}

}  // namespace

GltfFigure::GltfFigure(const GltfValue& document, GltfData& data, const GltfNodes& nodes,
                       std::size_t node)
    : data_(data), node_(node) {
  const GltfValue& value = nodes.shown()[node].value;
  if (const auto skin = value.find("skin"))
    read_skin(document.at("skins").item(skin->whole(kMostGltfItems)), nodes);
}

void GltfFigure::read_skin(const GltfValue& skin, const GltfNodes& nodes) {
  skinned_ = true;
  const GltfValue joints = skin.at("joints");
  if (joints.size() == 0) joints.refuse("the skin has no joints", "one at least");
  for (std::size_t n = 0; n < joints.size(); ++n) {
    const auto joint = nodes.find(joints.item(n).whole(kMostGltfItems));
    if (!joint) joints.item(n).refuse("the joint is no node of the scene that is shown", "one");
    joints_.push_back(*joint);
  }
  inverse_bind_.resize(joints_.size());
  const auto inverse = skin.find("inverseBindMatrices");
  if (!inverse) return;
  const std::size_t accessor = inverse->whole(kMostGltfItems);
  if (const std::size_t count = data_.count(accessor, kMostGltfItems); count < joints_.size())
    inverse->refuse("there are " + std::to_string(count) + " inverse bind matrices",
                    std::to_string(joints_.size()) + ", as there are joints");
  const std::vector<double> m = data_.numbers(accessor, "MAT4");
  for (std::size_t n = 0; n < joints_.size(); ++n) {
    const double* from = m.data() + 16 * n;
    for (std::size_t k = 0; k < 4; ++k)
      if (std::abs(from[4 * k + 3] - (k == 3)) > 1e-3)
        inverse->refuse("the last row of matrix " + std::to_string(n) + " is not 0 0 0 1",
                        "matrices that turn, scale and move");
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 3; ++k) inverse_bind_[n].columns[c][k] = from[4 * c + k];
    inverse_bind_[n].translation = {from[12], from[13], from[14]};
  }
}

std::size_t GltfFigure::add(const GltfValue& primitive, std::size_t most, std::size_t& count,
                            GltfSkinNotes& notes) {
  const GltfValue attributes = primitive.at("attributes");
  const GltfValue position = attributes.at("POSITION");
  Block block{position.place(), base_.size(), 0, {}};
  std::vector<std::size_t> accessors{position.whole(kMostGltfItems)};
  for (std::size_t set = 0; skinned_ && set < kMostSets; ++set)
    for (const char* kind : {"JOINTS_", "WEIGHTS_"})
      if (const auto given = attributes.find(set_name(kind, set).c_str()))
        accessors.push_back(given->whole(kMostGltfItems));
  const auto targets = primitive.find("targets");
  for (std::size_t t = 0; targets && t < targets->size(); ++t) {
    const auto moved = targets->item(t).find("POSITION");
    block.targets.emplace_back();
    if (moved) block.targets.back() = moved->whole(kMostGltfItems);
    accessors.push_back(moved ? *block.targets.back() : kMostGltfItems + 1);
  }
  count = data_.count(accessors[0], kMaxVertices);
  if (const auto known = block_of_.find(accessors); known != block_of_.end()) return known->second;
  if (!blocks_.empty() && block.targets.size() != target_count_)
    primitive.refuse("the primitive has " + std::to_string(block.targets.size()) + " targets",
                     std::to_string(target_count_) + ", as the one before it");
  target_count_ = block.targets.size();
  for (std::size_t t = 0; t < target_count_; ++t)
    if (block.targets[t] && data_.count(*block.targets[t], kMaxVertices) != count)
      targets->item(t)
          .at("POSITION")
          .refuse("the target moves " +
                      std::to_string(data_.count(*block.targets[t], kMaxVertices)) + " vertices",
                  std::to_string(count) + ", as there are");
  if (count > most - base_.size())
    position.refuse("the mesh has more vertices", "at most 4194304, of all nodes");
  const std::vector<double> values = data_.numbers(accessors[0], "VEC3");
  for (std::size_t v = 0; v < count; ++v)
    base_.push_back({values[3 * v], values[3 * v + 1], values[3 * v + 2]});
  if (skinned_) read_influences(attributes, count, notes);
  block.count = count;
  const std::size_t first = block.first;
  blocks_.push_back(std::move(block));
  return block_of_[accessors] = first;
}

void GltfFigure::read_influences(const GltfValue& attributes, std::size_t count,
                                 GltfSkinNotes& notes) {
  std::vector<std::vector<double>> joints, weights;
  std::vector<std::string> places;
  for (std::size_t set = 0; set <= kMostSets; ++set) {
    const auto list = attributes.find(set_name("JOINTS_", set).c_str());
    if (!list && set > 0) break;
    if (set == kMostSets) list->refuse("there are more sets of joints", "8 at most");
    const GltfValue of_joints = attributes.at(set_name("JOINTS_", set).c_str());
    const GltfValue of_weights = attributes.at(set_name("WEIGHTS_", set).c_str());
    for (const GltfValue* value : {&of_joints, &of_weights}) {
      const std::size_t accessor = value->whole(kMostGltfItems);
      if (const std::size_t n = data_.count(accessor, kMaxVertices); n != count)
        value->refuse("there are " + std::to_string(n) + " elements",
                      std::to_string(count) + ", as there are vertices");
      (value == &of_joints ? joints : weights).push_back(data_.numbers(accessor, "VEC4"));
    }
    places.push_back(of_joints.place());
  }
  std::vector<Influence> of_one;
  for (std::size_t v = 0; v < count; ++v) {
    of_one.clear();
    for (std::size_t set = 0; set < joints.size(); ++set)
      for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
        const double weight = weights[set][k], joint = joints[set][k];
        const auto wrong = [&](const std::string& what, std::string allowed) {
          throw Refused{{places[set], what + " of vertex " + std::to_string(v), allowed}};
        };
        if (weight < 0) wrong("a weight is " + number_words(weight) + ", that", "0 or above");
        if (weight == 0) continue;
        if (!(joint >= 0 && joint < double(joints_.size()) && joint == std::floor(joint)))
          wrong("a joint is " + number_words(joint) + ", that",
                "0 to " + std::to_string(joints_.size() - 1) + ", the joints of the skin");
        of_one.push_back({std::uint32_t(joint), float(weight)});
      }
    bind(of_one, notes);
  }
}

// Adds the influences of a vertex: one a joint, in their order, that sum to 1.
void GltfFigure::bind(std::vector<Influence>& of_one, GltfSkinNotes& notes) {
  double sum = 0;
  for (const Influence& one : of_one) sum += double(one.weight);
  if (!(sum > 1e-6)) {  // as viewers show it: with the first joint
    ++notes.unbound;
    of_one.assign(1, {0, 1});
    sum = 1;
  }
  if (std::abs(sum - 1) > kRoundedSum) {
    ++notes.unnormalised;
    if (std::abs(sum - 1) > std::abs(notes.sum - 1)) notes.sum = sum;
  }
  std::stable_sort(of_one.begin(), of_one.end(),
                   [](const Influence& a, const Influence& b) { return a.joint < b.joint; });
  const std::size_t first = influences_.size();
  for (const Influence& one : of_one) {
    const float share = float(double(one.weight) / sum);
    if (influences_.size() > first && influences_.back().joint == one.joint)
      influences_.back().weight += share;
    else
      influences_.push_back({one.joint, share});
  }
  begins_.push_back(influences_.size());
}

double GltfFigure::difference(std::size_t a, std::size_t b) const {
  double sum = 0;
  const auto one = influences(a), other = influences(b);
  for (std::size_t i = 0, k = 0; i < one.size() || k < other.size();) {
    const bool left = k == other.size() || (i < one.size() && one[i].joint <= other[k].joint);
    const bool right = i == one.size() || (k < other.size() && other[k].joint <= one[i].joint);
    sum += std::abs(double(left ? one[i].weight : 0) - double(right ? other[k].weight : 0));
    i += left;
    k += right;
  }
  return sum;
}

std::vector<GltfFigure::Displacement> GltfFigure::displacements(std::size_t target) {
  std::vector<Displacement> all(blocks_.back().first + blocks_.back().count);
  bool any = false;
  for (const Block& block : blocks_) {
    if (!block.targets[target]) continue;
    const std::vector<double> values = data_.numbers(*block.targets[target], "VEC3");
    for (std::size_t n = 0; n < values.size(); ++n) {
      all[block.first + n / 3][n % 3] = float(values[n]);
      any |= values[n] != 0;
    }
  }
  if (!any) all.clear();
  return all;
}

double GltfFigure::extent() const {
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax_element(
        base_.begin(), base_.end(), [k](const Vec3& a, const Vec3& b) { return a[k] < b[k]; });
    if (low != base_.end()) most = std::max(most, (*high)[k] - (*low)[k]);
  }
  return most;
}

std::vector<int> GltfFigure::weld() {
  std::vector<int> firsts = firsts_in_place(base_);
  if (skinned_)
    part(firsts,
         [&](int a, int b) { return difference(std::size_t(a), std::size_t(b)) > 2 * kSameShare; });
  const auto copies = [&] {
    for (std::size_t v = 0; v < firsts.size(); ++v)
      if (firsts[v] != int(v)) return true;
    return false;
  };
  const double least = kSameShare * extent();
  for (std::size_t t = 0; t < target_count_ && copies(); ++t)
    if (const std::vector<Displacement> moved = displacements(t); !moved.empty())
      part(firsts, [&](int a, int b) {
        const Displacement &p = moved[std::size_t(a)], &q = moved[std::size_t(b)];
        return double(std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2])) > least;
      });
  keep(firsts);
  return numbers_of(firsts);
}

void GltfFigure::keep(const std::vector<int>& firsts) {
  std::vector<Influence> influences;
  std::vector<std::size_t> begins{0};
  for (std::size_t v = 0; v < firsts.size(); ++v) {
    if (firsts[v] != int(v)) continue;
    base_[kept_.size()] = base_[v];
    kept_.push_back(v);
    if (!skinned_) continue;
    const auto own = this->influences(v);
    influences.insert(influences.end(), own.begin(), own.end());
    begins.push_back(influences.size());
  }
  base_.resize(kept_.size());
  influences_ = std::move(influences);
  begins_ = std::move(begins);
}

void GltfFigure::read_targets(bool all, std::span<const double> weights) {
  targets_.resize(target_count_);
  for (std::size_t t = 0; t < target_count_; ++t) {
    if (!all && (t >= weights.size() || weights[t] == 0)) continue;
    const std::vector<Displacement> given = displacements(t);
    if (given.empty()) continue;
    targets_[t].reserve(kept_.size());
    for (const std::size_t v : kept_) targets_[t].push_back(given[v]);
  }
}

std::size_t GltfFigure::work() const {
  constexpr std::size_t kTransform = 8;
  std::size_t moving = 0;
  for (const std::vector<Displacement>& target : targets_) moving += !target.empty();
  return base_.size() * (1 + moving) + influences_.size() + kTransform * joints_.size() +
         targets_.size();
}

std::vector<Vec3> GltfFigure::vertices(const GltfPose& pose) const {
  std::vector<Vec3> x = base_;
  const std::vector<double>& weights = pose.weights[node_];
  for (std::size_t t = 0; t < std::min(targets_.size(), weights.size()); ++t) {
    if (weights[t] == 0 || targets_[t].empty()) continue;
    for (std::size_t v = 0; v < x.size(); ++v)
      for (std::size_t k = 0; k < 3; ++k) x[v][k] += weights[t] * double(targets_[t][v][k]);
  }
  std::vector<Affine> joints;
  for (std::size_t j = 0; j < joints_.size(); ++j)
    joints.push_back(pose.places[joints_[j]] * inverse_bind_[j]);
  for (std::size_t v = 0; v < x.size(); ++v) {
    const Vec3 from = x[v];
    if (!skinned_) x[v] = pose.places[node_](from);
    if (skinned_) x[v] = {};
    for (const Influence& one : skinned_ ? influences(v) : std::span<const Influence>{}) {
      const Vec3 to = joints[one.joint](from);
      for (std::size_t k = 0; k < 3; ++k) x[v][k] += double(one.weight) * to[k];
    }
    for (const double value : x[v])
      if (!(std::abs(value) <= kFarthestPlace)) refuse_far(v, value);
  }
  return x;
}

void GltfFigure::refuse_far(std::size_t vertex, double value) const {
  const std::size_t given = kept_[vertex];
  const auto after = std::upper_bound(blocks_.begin(), blocks_.end(), given,
                                      [](std::size_t v, const Block& b) { return v < b.first; });
  const Block& block = *std::prev(after);
  throw Refused{
      {block.place,
       "vertex " + std::to_string(given - block.first) + " lies at " + number_words(value),
       "-1e9 to 1e9, with the transforms of its nodes"}};
}

}  // namespace weft::text
