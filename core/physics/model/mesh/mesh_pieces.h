// Of the vertices about one of a mesh, which hang together without it.
#pragma once

#include <cstddef>
#include <vector>

namespace weft::physics {

class MeshPieces {
 public:
  void clear() {
    vertices_.clear();
    parent_.clear();
    areas_.clear();
  }
  // The piece that a vertex belongs to, one of its own if it is new.
  int find(int vertex) {
    for (std::size_t n = 0; n < vertices_.size(); ++n)
      if (vertices_[n] == vertex) return root(int(n));
    vertices_.push_back(vertex);
    parent_.push_back(int(parent_.size()));
    areas_.push_back(0);
    return parent_.back();
  }
  void join(int a, int b) {
    const int first = find(a), second = find(b);
    parent_[std::size_t(second)] = first;
  }

  // m², of the triangles that a piece has with the vertex; add them once all are joined.
  double& area(int piece) { return areas_[std::size_t(piece)]; }
  // The piece with most, the first of those alike; -1: none has any.
  int largest() const {
    constexpr double kAlike = 1e-9;
    int kept = -1;
    for (std::size_t n = 0; n < areas_.size(); ++n)
      if (areas_[n] > 0 && (kept < 0 || areas_[n] > areas_[std::size_t(kept)] * (1 + kAlike)))
        kept = int(n);
    return kept;
  }

 private:
  int root(int n) const {
    while (parent_[std::size_t(n)] != n) n = parent_[std::size_t(n)];
    return n;
  }
  std::vector<int> vertices_, parent_;
  std::vector<double> areas_;
};

}  // namespace weft::physics
