// The patches of a mesh (mesh_patches.h).
#include "physics/contact/self/mesh_patches.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <set>
#include <span>

#include "weft/vec3.h"

namespace weft::physics {
namespace {

constexpr std::size_t kFew = 4096;  // vertices that one thread copies faster
constexpr double kDetour = 2;       // along edges, of the straight way between neighbours

// Small meshes in small patches, so that they have some; large ones in large, so that there are few.
std::size_t patch_size(std::size_t vertices) {
  return vertices <= 25000 ? 128 : vertices <= 400000 ? 512 : 2048;
}

// Whether a way by edges and seams is shorter than the straight one, and so leads over a seam.
bool shorter(double way, double straight) {
  constexpr double kRounding = 1e-9;
  return way == 0 || way < straight * (1 - kRounding);
}

double apart(const Vec3& a, const Vec3& b) {
  const Vec3 d = minus(a, b);
  return length(d);
}

// Halves of halves, each cut across where it is longest (a k-d tree, Bentley 1975), down to a size.
void cut(std::span<int> vertices, const std::vector<Vec3>& at, std::size_t size,
         std::vector<int>& counts) {
  if (vertices.size() <= size) {
    std::sort(vertices.begin(), vertices.end());
    counts.push_back(int(vertices.size()));
    return;
  }
  Vec3 low = at[std::size_t(vertices[0])], high = low;
  for (const int v : vertices)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], at[std::size_t(v)][k]);
      high[k] = std::max(high[k], at[std::size_t(v)][k]);
    }
  const Vec3 sides = minus(high, low);
  const auto axis = std::size_t(std::max_element(sides.begin(), sides.end()) - sides.begin());
  const std::size_t half = vertices.size() / 2;
  std::nth_element(vertices.begin(), vertices.begin() + std::ptrdiff_t(half), vertices.end(),
                   [&](int a, int b) {
                     const double x = at[std::size_t(a)][axis], y = at[std::size_t(b)][axis];
                     return x != y ? x < y : a < b;
                   });
  cut(vertices.first(half), at, size, counts);
  cut(vertices.subspan(half), at, size, counts);
}

}  // namespace

MeshPatches::MeshPatches(const ClothModel& model, std::vector<Vec3> rest)
    : particles_(model.particles()), surface_(model.surface()), rest_(std::move(rest)) {
  std::vector<int> vertices(rest_.size()), counts;
  std::iota(vertices.begin(), vertices.end(), 0);
  cut(vertices, rest_, patch_size(rest_.size()), counts);
  for (const int v : vertices) places_.push_back(particles_.place(v));
  points_ = std::make_unique<Particles>(counts, false, std::move(vertices));
  x_.resize(places_.size());
  v_.resize(places_.size());
}

void MeshPatches::copy(Threads& threads) {
  threads.share(std::size_t(points_->rows), rest_.size() < kFew, [&](std::size_t row) {
    const int j = int(row);
    auto n = std::size_t(points_->first[row]);
    for (int i = 0; i < points_->count(j); ++i, ++n) {
      const Particles::Place from = places_[n];
      for (int k = 0; k < 3; ++k) {
        points_->x.at(k, j, i) = x_[n].x[k] = particles_.x.at(k, from.j, from.i);
        points_->v.at(k, j, i) = v_[n].x[k] = particles_.v.at(k, from.j, from.i);
      }
      points_->w(j)[i] = particles_.w(from.j, from.i);
    }
  });
}

std::vector<std::vector<Particles::Place>> MeshPatches::borders() const {
  using At = std::pair<int, int>;
  std::vector<std::set<At>> beyond(std::size_t(points_->rows));
  for (const auto& triangle : triangles())
    for (const int vertex : triangle)
      for (const int other : triangle) {
        const auto [row, column] = points_->place(other);
        const int patch = points_->place(vertex).j;
        if (row != patch) beyond[std::size_t(patch)].insert({row, column});
      }
  std::vector<std::vector<Particles::Place>> borders;
  for (const std::set<At>& of : beyond) {
    borders.emplace_back();
    for (const auto& [row, column] : of) borders.back().push_back({row, column});
  }
  return borders;
}

// The shortest ways from each vertex (Dijkstra 1959), as far as they matter.
template <class Visit>
void MeshPatches::for_each_way(double most, const Visit& visit) const {
  std::vector<std::vector<int>> joined(rest_.size()), sewn(rest_.size());
  for (const auto& t : surface_.all())
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3})
        joined[std::size_t(t[k])].push_back(t[other]);
  for (const std::vector<int>& group : surface_.sewn)
    for (const int vertex : group) sewn[std::size_t(vertex)] = group;
  using Reached = std::pair<double, int>;
  std::vector<double> way(rest_.size(), std::numeric_limits<double>::infinity());
  for (std::size_t v = 0; v < rest_.size(); ++v) {
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
    std::vector<int> reached;
    const auto reach = [&](int vertex, double length) {
      if (length > most || length >= way[std::size_t(vertex)]) return;
      if (std::isinf(way[std::size_t(vertex)])) reached.push_back(vertex);
      way[std::size_t(vertex)] = length;
      next.push({length, vertex});
    };
    reach(int(v), 0);
    while (!next.empty()) {
      const auto [length, from] = next.top();
      next.pop();
      if (length > way[std::size_t(from)]) continue;
      for (const int to : joined[std::size_t(from)])
        reach(to, length + apart(rest_[std::size_t(from)], rest_[std::size_t(to)]));
      for (const int to : sewn[std::size_t(from)]) reach(to, length);
    }
    std::sort(reached.begin(), reached.end());
    for (const int vertex : reached) {
      if (vertex != int(v)) visit(v, vertex, way[std::size_t(vertex)]);
      way[std::size_t(vertex)] = std::numeric_limits<double>::infinity();
    }
  }
}

std::vector<std::vector<int>> MeshPatches::neighbours(double range) const {
  std::vector<std::vector<int>> near(rest_.size());
  for_each_way(kDetour * range, [&](std::size_t v, int other, double way) {
    const double straight = apart(rest_[v], rest_[std::size_t(other)]);
    if (straight < range || shorter(way, straight)) near[v].push_back(other);
  });
  return near;
}

std::vector<std::vector<int>> MeshPatches::sewn_neighbours(double range) const {
  std::vector<std::vector<int>> near(rest_.size());
  for_each_way(range, [&](std::size_t v, int other, double way) {
    if (shorter(way, apart(rest_[v], rest_[std::size_t(other)]))) near[v].push_back(other);
  });
  return near;
}

std::size_t MeshPatches::bytes() const {
  return points_->bytes() +
         rest_.size() * (sizeof(Vec3) + sizeof(Particles::Place) + 2 * sizeof(Place));
}

}  // namespace weft::physics
