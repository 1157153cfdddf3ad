#include "scene/mesh/gltf_nodes.h"

#include <set>

namespace weft::text {
namespace {

// The nodes that nothing has as a child, in order; or those of the scene that is shown.
std::vector<std::size_t> roots_of(const GltfValue& document) {
  std::vector<std::size_t> roots;
  const auto nodes = document.find("nodes");
  if (!nodes) return roots;
  if (const auto scenes = document.find("scenes"); scenes && scenes->size() > 0) {
    const GltfValue scene = scenes->item(document.whole_or("scene", 0, kMostGltfItems));
    if (const auto list = scene.find("nodes"))
      for (std::size_t n = 0; n < list->size(); ++n)
        roots.push_back(list->item(n).whole(kMostGltfItems));
    return roots;
  }
  std::set<std::size_t> children;
  for (std::size_t n = 0; n < nodes->size(); ++n)
    if (const auto list = nodes->item(n).find("children"))
      for (std::size_t k = 0; k < list->size(); ++k)
        children.insert(list->item(k).whole(kMostGltfItems));
  for (std::size_t n = 0; n < nodes->size(); ++n)
    if (!children.contains(n)) roots.push_back(n);
  return roots;
}

LocalTransform local_of(const GltfValue& node) {
  LocalTransform local;
  if (node.find("matrix")) {
    const std::array<double, 16> m = node.numbers_or<16>("matrix", {});
    local.matrix.emplace();
    for (std::size_t n = 0; n < 3; ++n)
      for (std::size_t k = 0; k < 3; ++k) local.matrix->columns[n][k] = m[4 * n + k];
    local.matrix->translation = {m[12], m[13], m[14]};
    return local;
  }
  local.rotation = node.numbers_or<4>("rotation", local.rotation);
  if (!is_rotation(local.rotation))
    node.at("rotation").refuse("the quaternion is no rotation", "a unit quaternion");
  local.scale = node.numbers_or<3>("scale", local.scale);
  local.translation = node.numbers_or<3>("translation", local.translation);
  return local;
}

}  // namespace

GltfNodes::GltfNodes(const GltfValue& document) {
  struct Waiting {
    std::size_t node;
    int parent;
  };
  const std::vector<std::size_t> roots = roots_of(document);
  std::vector<Waiting> waiting;
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) waiting.push_back({*root, -1});
  while (!waiting.empty()) {
    const auto [number, parent] = waiting.back();
    waiting.pop_back();
    const GltfValue node = document.at("nodes").item(number);
    const int here = int(shown_.size());
    if (!numbers_.try_emplace(number, here).second)
      node.refuse("the node has two parents, or is below itself", "a tree of nodes");
    shown_.push_back({node, parent, local_of(node)});
    const auto children = node.find("children");
    for (std::size_t k = children ? children->size() : 0; k > 0; --k)
      waiting.push_back({children->item(k - 1).whole(kMostGltfItems), here});
  }
}

std::optional<std::size_t> GltfNodes::find(std::size_t number) const {
  const auto found = numbers_.find(number);
  if (found == numbers_.end()) return {};
  return found->second;
}

std::vector<Affine> GltfNodes::places(const std::vector<LocalTransform>& locals) const {
  std::vector<Affine> places;
  places.reserve(shown_.size());
  for (std::size_t n = 0; n < shown_.size(); ++n) {
    const int parent = shown_[n].parent;
    const Affine local = locals[n].affine();
    places.push_back(parent < 0 ? local : places[std::size_t(parent)] * local);
  }
  return places;
}

std::vector<LocalTransform> GltfNodes::at_rest() const {
  std::vector<LocalTransform> all;
  for (const Node& node : shown_) all.push_back(node.at_rest);
  return all;
}

}  // namespace weft::text
