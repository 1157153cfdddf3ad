// The vertices of a glTF node's mesh, and what moves them: the node, or the joints of its skin, and morph targets.
#pragma once

#include <array>
#include <map>
#include <span>
#include <vector>

#include "scene/mesh/gltf_data.h"
#include "scene/mesh/gltf_nodes.h"

namespace weft::text {

// What all nodes that are shown are like at one time.
struct GltfPose {
  std::vector<Affine> places;  // of the nodes
  std::vector<std::vector<double>>
      weights;  // of each node's morph targets; as many as it has, or none
};

// What is odd about skins, though not wrong.
struct GltfSkinNotes {
  std::size_t unbound = 0;       // vertices without a weight
  std::size_t unnormalised = 0;  // whose weights sum to something else than 1
  double sum = 1;                // of those, the one that is the farthest from 1
};

class GltfFigure {
 public:
  // `node`: among those that are shown. Reads its skin.
  GltfFigure(const GltfValue& document, GltfData& data, const GltfNodes& nodes, std::size_t node);

  // Reads the vertices of a primitive, which has positions; those that another one has read already are the same.
  // Returns the number of the first; `most`: of vertices.
  std::size_t add(const GltfValue& primitive, std::size_t most, std::size_t& count,
                  GltfSkinNotes& notes);
  std::size_t size() const { return base_.size(); }

  // Makes one of vertices that lie in one place and stay together, whatever the pose: by joints, weights and
  // displacements that differ by so little that nobody sees. Keeps the order of those that are left. Returns the
  // new number of each.
  std::vector<int> weld();
  // Reads the displacements of targets, after weld(): of all, or of those with a weight.
  void read_targets(bool all, std::span<const double> weights);

  std::size_t node() const { return node_; }
  std::size_t targets() const { return target_count_; }
  std::size_t joints() const { return joints_.size(); }
  // About what vertices() costs, in multiplications of three numbers.
  std::size_t work() const;
  // Where the vertices are; refused: beyond 1e9.
  std::vector<Vec3> vertices(const GltfPose& pose) const;

 private:
  using Displacement = std::array<float, 3>;
  struct Influence {
    std::uint32_t joint;
    float weight;
  };
  struct Block {  // of a primitive
    std::string place;
    std::size_t first, count;
    std::vector<std::optional<std::size_t>> targets;  // their accessors
  };
  static constexpr std::size_t kMostSets = 8;  // of four joints and weights each

  void read_skin(const GltfValue& skin, const GltfNodes& nodes);
  void read_influences(const GltfValue& attributes, std::size_t count, GltfSkinNotes& notes);
  void bind(std::vector<Influence>& of_one, GltfSkinNotes& notes);
  std::span<const Influence> influences(std::size_t vertex) const {
    return {influences_.data() + begins_[vertex], influences_.data() + begins_[vertex + 1]};
  }
  // How much of two vertices' weights is not common to them: 0 … 2.
  double difference(std::size_t a, std::size_t b) const;
  // Of one target, of all vertices as given; empty: it moves none.
  std::vector<Displacement> displacements(std::size_t target);
  double extent() const;  // the greatest along an axis
  void keep(const std::vector<int>& firsts);
  [[noreturn]] void refuse_far(std::size_t vertex, double value) const;

  GltfData& data_;
  std::size_t node_;
  bool skinned_ = false;
  std::vector<std::size_t> joints_;  // among the nodes that are shown
  std::vector<Affine> inverse_bind_;
  std::vector<Vec3> base_;
  std::vector<std::size_t> begins_{0};  // of each vertex's influences, and the end
  std::vector<Influence> influences_;
  std::vector<Block> blocks_;
  std::map<std::vector<std::size_t>, std::size_t> block_of_;  // by the accessors that it reads
  std::vector<std::size_t> kept_;                             // of the vertices as given
  std::size_t target_count_ = 0;
  std::vector<std::vector<Displacement>> targets_;  // empty: not read, or all 0
};

}  // namespace weft::text
