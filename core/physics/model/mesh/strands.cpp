#include "physics/model/mesh/strands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "weft/vec3.h"

namespace weft::physics {
namespace {

constexpr double kStraight = 0.7;  // cosine of the greatest bend

// The edge that each goes on with at its first and at its second end; -1: none.
using Continued = std::vector<std::array<int, 2>>;

class Pairing {
 public:
  Pairing(const MeshEdges& edges, const std::vector<Vec3>& x)
      : edges_(edges), x_(x), around_(x.size()), next_(edges.ends.size(), {-1, -1}) {
    for (std::size_t e = 0; e < edges.ends.size(); ++e)
      for (const int v : edges.ends[e]) around_[std::size_t(v)].push_back(int(e));
  }

  const Continued& run() {
    for (int v = 0; v < int(around_.size()); ++v) pair_at(v);
    return next_;
  }

 private:
  int side(int edge, int vertex) const {
    return edges_.ends[std::size_t(edge)][0] == vertex ? 0 : 1;
  }
  // From the vertex along the edge, of length 1.
  Vec3 way(int edge, int vertex) const {
    const auto& ends = edges_.ends[std::size_t(edge)];
    const int other = ends[std::size_t(1 - side(edge, vertex))];
    return times(minus(x_[std::size_t(other)], x_[std::size_t(vertex)]),
                 1 / edges_.rest[std::size_t(edge)]);
  }

  void pair_at(int v) {
    const std::vector<int>& around = around_[std::size_t(v)];
    std::vector<std::tuple<double, int, int>> pairs;  // minus the cosine of the bend
    for (std::size_t a = 0; a < around.size(); ++a)
      for (std::size_t b = a + 1; b < around.size() && around.size() <= kMostAround; ++b) {
        const double turned = dot(way(around[a], v), way(around[b], v));
        if (turned < -kStraight) pairs.emplace_back(turned, around[a], around[b]);
      }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [turned, a, b] : pairs) {
      int &from = next_[std::size_t(a)][std::size_t(side(a, v))],
          &to = next_[std::size_t(b)][std::size_t(side(b, v))];
      if (from >= 0 || to >= 0) continue;
      from = b;
      to = a;
    }
  }

  static constexpr std::size_t kMostAround = 256;  // where more meet, strands end
  const MeshEdges& edges_;
  const std::vector<Vec3>& x_;
  std::vector<std::vector<int>> around_;  // edges of every vertex
  Continued next_;
};

// Follows edges from one on that has not been met, from its end `side`.
Strand followed(const MeshEdges& edges, const Continued& next, int edge, std::size_t side,
                std::vector<char>& met, std::vector<int>& seen, int round) {
  Strand s;
  s.vertices.push_back(edges.ends[std::size_t(edge)][side]);
  seen[std::size_t(s.vertices[0])] = round;
  while (edge >= 0 && !met[std::size_t(edge)]) {
    const auto& ends = edges.ends[std::size_t(edge)];
    const std::size_t far = ends[0] == s.vertices.back() ? 1 : 0;
    if (seen[std::size_t(ends[far])] == round) break;  // it comes back to itself
    seen[std::size_t(ends[far])] = round;
    met[std::size_t(edge)] = 1;
    s.edges.push_back(edge);
    s.vertices.push_back(ends[far]);
    edge = next[std::size_t(edge)][far];
  }
  return s;
}

}  // namespace

std::vector<Strand> strands_of(const MeshEdges& edges, const std::vector<Vec3>& x) {
  Pairing pairing(edges, x);
  const Continued& next = pairing.run();
  std::vector<Strand> all;
  std::vector<char> met(edges.ends.size(), 0);
  std::vector<int> seen(x.size(), -1);
  // From the ends first; what is left goes round.
  for (const bool round : {false, true})
    for (int e = 0; e < int(edges.ends.size()); ++e) {
      const auto& [a, b] = next[std::size_t(e)];
      if (met[std::size_t(e)] || (!round && a >= 0 && b >= 0)) continue;
      all.push_back(followed(edges, next, e, a < 0 ? 0 : 1, met, seen, int(all.size())));
    }
  return all;
}

std::vector<std::vector<int>> coloured_strands(const std::vector<Strand>& strands, int vertices) {
  std::vector<int> order(strands.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return strands[std::size_t(a)].edges.size() > strands[std::size_t(b)].edges.size();
  });
  std::vector<std::vector<int>> colours;
  std::vector<std::vector<int>> taken(std::size_t(vertices), std::vector<int>{});  // colours
  std::vector<int> asked;  // by which strand, of every colour
  for (const int n : order) {
    const Strand& s = strands[std::size_t(n)];
    for (const int v : s.vertices)
      for (const int c : taken[std::size_t(v)]) asked[std::size_t(c)] = n;
    std::size_t free = 0;
    while (free < asked.size() && asked[free] == n) ++free;
    if (free == colours.size()) {
      colours.emplace_back();
      asked.push_back(-1);
    }
    colours[free].push_back(n);
    for (const int v : s.vertices) taken[std::size_t(v)].push_back(int(free));
  }
  return colours;
}

}  // namespace weft::physics
