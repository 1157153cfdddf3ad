// A tree of boxes (bounding volume hierarchy) over items, halved along the longest side of their middles. What
// is asked of it visits every item that may matter, whatever the shape of the tree.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "physics/model/vector.h"

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
  // Squared distance of a point [m²]; 0 inside.
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
  const AlignedBox& bounds() const { return nodes_[0].box; }
  std::size_t bytes() const {
    return nodes_.size() * sizeof(Node) + order_.size() * sizeof(order_[0]);
  }

  // Calls visit(item) for all items whose boxes may be nearer to p than the root of `square` [m²], which visit
  // lowers as it finds them; those as near are visited, too.
  template <class Visit>
  void nearest(const Vec3& p, const double& square, Visit&& visit) const {
    // What is as near but for rounding is looked at: which item comes first does not matter.
    constexpr double kRounding = 1 + 1e-9;
    struct Left {
      int node;
      double square;
    };
    Left left[kDeepest];
    int count = 0;
    left[count++] = {0, nodes_[0].box.square_from(p)};
    while (count > 0) {
      const Left next = left[--count];
      if (next.square > square * kRounding) continue;
      const Node& node = nodes_[std::size_t(next.node)];
      if (node.count > 0) {
        for (int n = 0; n < node.count; ++n) visit(order_[std::size_t(node.first + n)]);
        continue;
      }
      Left near{next.node + 1, nodes_[std::size_t(next.node) + 1].box.square_from(p)};
      Left far{node.first, nodes_[std::size_t(node.first)].box.square_from(p)};
      if (far.square < near.square) std::swap(near, far);
      left[count++] = far;
      left[count++] = near;
    }
  }

  // Calls visit(item) for all items in leaves that meet a box and of whose nodes wanted(node) holds.
  template <class Wanted, class Visit>
  void within(const AlignedBox& box, Wanted&& wanted, Visit&& visit) const {
    int left[kDeepest];
    int count = 0;
    if (!nodes_.empty()) left[count++] = 0;
    while (count > 0) {
      const int at = left[--count];
      const Node& node = nodes_[std::size_t(at)];
      if (!node.box.meets(box) || !wanted(at)) continue;
      if (node.count > 0) {
        for (int n = 0; n < node.count; ++n) visit(order_[std::size_t(node.first + n)]);
        continue;
      }
      left[count++] = node.first;
      left[count++] = at + 1;
    }
  }
  template <class Visit>
  void within(const AlignedBox& box, Visit&& visit) const {
    within(
        box, [](int) { return true; }, visit);
  }

  // The least value of the items below each node.
  std::vector<double> least_of(const std::vector<double>& values) const {
    std::vector<double> least(nodes_.size(), 1e300);
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
    AlignedBox box;
    int first =
        0;  // of a leaf: of its items in the order; else the second child, the first being next
    int count = 0;  // of a leaf; else 0
  };

  int build(const std::vector<AlignedBox>& boxes, int begin, int end) {
    const int at = int(nodes_.size());
    nodes_.emplace_back();
    AlignedBox box, middles;
    for (int n = begin; n < end; ++n) {
      const AlignedBox& b = boxes[std::size_t(order_[std::size_t(n)])];
      box.add(b);
      middles.add(plus(b.low, b.high));
    }
    nodes_.back().box = box;
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
