// A tree of boxes (bounding volume hierarchy) over items, halved along the longest side of their middles. It keeps
// how they hang together; where the boxes are is told by those who ask, as a function of the node, for items that
// move keep their places in the tree. What is asked of it visits every item that may matter, whatever its shape.
#pragma once

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "weft/vec3.h"

namespace weft::physics {

struct AlignedBox {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void add(const Vec3& p) {
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  }
  void add(const AlignedBox& b) {
    add(b.low);
    add(b.high);
  }
  AlignedBox grown(double by) const {
    AlignedBox b = *this;
    for (std::size_t k = 0; k < 3; ++k) b.low[k] -= by, b.high[k] += by;
    return b;
  }
  bool meets(const AlignedBox& b) const {
    return low[0] <= b.high[0] && b.low[0] <= high[0] && low[1] <= b.high[1] &&
           b.low[1] <= high[1] && low[2] <= b.high[2] && b.low[2] <= high[2];
  }
  // Squared distance of another [m²]; 0 where they meet.
  double square_from(const AlignedBox& b) const {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double out = std::max(std::max(low[k] - b.high[k], b.low[k] - high[k]), 0.0);
      square += out * out;
    }
    return square;
  }
  // Of a point; 0 inside.
  double square_from(const Vec3& p) const {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double out = std::max(std::max(low[k] - p[k], p[k] - high[k]), 0.0);
      square += out * out;
    }
    return square;
  }
};

class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<AlignedBox>& boxes) : order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    if (!boxes.empty()) build(boxes, 0, int(boxes.size()));
  }

  bool empty() const { return nodes_.empty(); }
  std::size_t bytes() const {
    return nodes_.size() * sizeof(Node) + order_.size() * sizeof(order_[0]);
  }

  // The boxes of all nodes, where the items have the boxes box_of(item).
  template <class BoxOf>
  std::vector<AlignedBox> refitted(BoxOf&& box_of) const {
    std::vector<AlignedBox> boxes(nodes_.size());
    for (std::size_t n = nodes_.size(); n-- > 0;) {
      const Node& node = nodes_[n];
      for (int k = 0; k < node.count; ++k)
        boxes[n].add(box_of(order_[std::size_t(node.first + k)]));
      if (node.count > 0) continue;
      boxes[n].add(boxes[n + 1]);
      boxes[n].add(boxes[std::size_t(node.first)]);
    }
    return boxes;
  }

  // Calls visit(item) for all items whose boxes may be nearer than the root of `square` [m²], which visit lowers as
  // it finds them; those as near are visited, too. square_of(node): how far its box is [m²].
  template <class SquareOf, class Visit>
  void nearest(const SquareOf& square_of, const double& square, Visit&& visit) const {
    // What is as near but for rounding is looked at: which item comes first does not matter.
    constexpr double kRounding = 1 + 1e-9;
    struct Left {
      int node;
      double square;
    };
    Left left[kDeepest];
    int count = 0;
    left[count++] = {0, square_of(0)};
    while (count > 0) {
      const Left next = left[--count];
      if (next.square > square * kRounding) continue;
      const Node& node = nodes_[std::size_t(next.node)];
      if (node.count > 0) {
        for (int n = 0; n < node.count; ++n) visit(order_[std::size_t(node.first + n)]);
        continue;
      }
      Left near{next.node + 1, square_of(next.node + 1)};
      Left far{node.first, square_of(node.first)};
      if (far.square < near.square) std::swap(near, far);
      left[count++] = far;
      left[count++] = near;
    }
  }

  // Calls visit(item) for all items in leaves of whose nodes, and of those above, wanted(node) holds.
  template <class Wanted, class Visit>
  void visit(Wanted&& wanted, Visit&& visit) const {
    int left[kDeepest];
    int count = 0;
    if (!nodes_.empty()) left[count++] = 0;
    while (count > 0) {
      const int at = left[--count];
      const Node& node = nodes_[std::size_t(at)];
      if (!wanted(at)) continue;
      if (node.count > 0) {
        for (int n = 0; n < node.count; ++n) visit(order_[std::size_t(node.first + n)]);
        continue;
      }
      left[count++] = node.first;
      left[count++] = at + 1;
    }
  }

  // The least value of the items below each node.
  std::vector<double> least_of(const std::vector<double>& values) const {
    std::vector<double> least(nodes_.size(), std::numeric_limits<double>::infinity());
    for (std::size_t n = nodes_.size(); n-- > 0;) {
      const Node& node = nodes_[n];
      for (int k = 0; k < node.count; ++k)
        least[n] = std::min(least[n], values[std::size_t(order_[std::size_t(node.first + k)])]);
      if (node.count == 0) least[n] = std::min(least[n + 1], least[std::size_t(node.first)]);
    }
    return least;
  }

 private:
  static constexpr int kLeaf = 4, kDeepest = 64;  // halves of less than 2^31 items
  struct Node {
    // Of a leaf: of its items in the order; else the second child, the first being next.
    int first = 0;
    int count = 0;  // of a leaf; else 0
  };

  int build(const std::vector<AlignedBox>& boxes, int begin, int end) {
    const int at = int(nodes_.size());
    nodes_.emplace_back();
    AlignedBox middles;
    for (int n = begin; n < end; ++n) {
      const AlignedBox& b = boxes[std::size_t(order_[std::size_t(n)])];
      middles.add(plus(b.low, b.high));
    }
    if (end - begin <= kLeaf) {
      nodes_.back().first = begin;
      nodes_.back().count = end - begin;
      return at;
    }
    const Vec3 size = minus(middles.high, middles.low);
    const auto axis = std::size_t(std::max_element(size.begin(), size.end()) - size.begin());
    const auto key = [&](int item) {
      const AlignedBox& b = boxes[std::size_t(item)];
      return std::pair(b.low[axis] + b.high[axis], item);
    };
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int a, int b) { return key(a) < key(b); });
    build(boxes, begin, middle);
    const int second = build(boxes, middle, end);
    nodes_[std::size_t(at)].first = second;
    return at;
  }

  std::vector<Node> nodes_;  // a node's first child comes next
  std::vector<int> order_;   // of the items
};

}  // namespace weft::physics
