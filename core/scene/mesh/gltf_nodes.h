// The nodes of the scene that a glTF document shows.
#pragma once

#include <map>
#include <vector>

#include "scene/mesh/gltf_transform.h"
#include "scene/mesh/gltf_value.h"

namespace weft::text {

inline constexpr std::size_t kMostGltfItems = kMaxLists;

class GltfNodes {
 public:
  struct Node {
    GltfValue value;
    int parent;              // among the nodes that are shown, or -1
    LocalTransform at_rest;  // as the file has it
  };

  // Refused: a node with two parents, or below itself.
  explicit GltfNodes(const GltfValue& document);

  // Each after its parent, in the order in which a walk down the tree meets them.
  const std::vector<Node>& shown() const { return shown_; }
  // Where a node of the document is among them; nothing where it is not shown.
  std::optional<std::size_t> find(std::size_t number) const;
  // Of every node that is shown, its transform for such local ones.
  std::vector<Affine> places(const std::vector<LocalTransform>& locals) const;
  std::vector<LocalTransform> at_rest() const;

 private:
  std::vector<Node> shown_;
  std::map<std::size_t, std::size_t> numbers_;
};

}  // namespace weft::text
