#include "physics/model/mesh/mesh_attachments.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "physics/kernels/second_order.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

constexpr double kNone = -1;

// How far c is from what is so far from a and from b, beyond the side ab of a flat triangle; kNone where the
// straight line does not cross it.
double through(const Vec3& a, const Vec3& b, const Vec3& c, double from_a, double from_b) {
  const double side = distance(a, b);
  const double along = dot(minus(c, a), minus(b, a)) / side;
  const double up = std::sqrt(std::max(0.0, std::pow(distance(a, c), 2) - along * along));
  const double x = (from_a * from_a - from_b * from_b + side * side) / (2 * side);
  const double squared = from_a * from_a - x * x;
  if (!(squared >= 0) || up == 0) return kNone;
  const double down = std::sqrt(squared), crossing = x + (along - x) * down / (down + up);
  if (!(crossing >= 0 && crossing <= side)) return kNone;
  return std::hypot(along - x, up + down);
}

class Spreading {
 public:
  Spreading(const TriangleMesh& mesh, const std::vector<Vec3>& x, const std::vector<int>& pins)
      : mesh_(mesh), x_(x), around_(x.size()), group_(x.size(), -1), reached_(x.size()) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const int v : mesh.triangles[t]) around_[std::size_t(v)].push_back(int(t));
    make_groups(pins);
    for (const int pin : pins) queue_.emplace(0, pin, pin);
  }

  const std::vector<std::vector<Tether>>& run() {
    while (!queue_.empty()) {
      const auto [reach, vertex, pin] = queue_.top();
      queue_.pop();
      std::vector<Tether>& here = reached_[std::size_t(vertex)];
      if (here.size() == kTethers || knows(vertex, pin)) continue;
      here.push_back({pin, reach});
      for (const int t : around_[std::size_t(vertex)]) spread(t, vertex, pin, reach);
    }
    return reached_;
  }

 private:
  // Pins that edges join are one group: the number of one of them.
  void make_groups(const std::vector<int>& pins) {
    std::vector<char> pinned(x_.size(), 0);
    for (const int pin : pins) pinned[std::size_t(pin)] = 1;
    for (const int pin : pins) {
      if (group_[std::size_t(pin)] >= 0) continue;
      std::vector<int> members{pin};
      group_[std::size_t(pin)] = pin;
      for (std::size_t n = 0; n < members.size(); ++n)
        for (const int t : around_[std::size_t(members[n])])
          for (const int v : mesh_.triangles[std::size_t(t)]) {
            if (!pinned[std::size_t(v)] || group_[std::size_t(v)] >= 0) continue;
            group_[std::size_t(v)] = pin;
            members.push_back(v);
          }
    }
  }

  bool knows(int vertex, int pin) const {
    const auto& there = reached_[std::size_t(vertex)];
    return std::any_of(there.begin(), there.end(), [&](const Tether& t) {
      return group_[std::size_t(t.pin)] == group_[std::size_t(pin)];
    });
  }

  void spread(int triangle, int vertex, int pin, double reach) {
    const auto& corners = mesh_.triangles[std::size_t(triangle)];
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners[k] == vertex) continue;
      const int to = corners[k], other = corners[0] + corners[1] + corners[2] - vertex - to;
      if (knows(to, pin)) continue;
      const Vec3 &a = x_[std::size_t(vertex)], &b = x_[std::size_t(other)],
                 &c = x_[std::size_t(to)];
      double least = reach + distance(a, c);
      for (const Tether& t : reached_[std::size_t(other)])
        if (t.pin == pin)
          if (const double straight = through(a, b, c, reach, t.reach); straight != kNone)
            least = std::min(least, straight);
      queue_.emplace(least, to, pin);
    }
  }

  using Step = std::tuple<double, int, int>;  // distance, vertex, pin
  const TriangleMesh& mesh_;
  const std::vector<Vec3>& x_;
  std::vector<std::vector<int>> around_;  // triangles of every vertex
  std::vector<int> group_;                // of the pins
  std::vector<std::vector<Tether>> reached_;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> queue_;
};

}  // namespace

std::vector<std::vector<Tether>> mesh_attachments(const TriangleMesh& mesh,
                                                  const std::vector<Vec3>& x,
                                                  const std::vector<int>& pins) {
  std::vector<std::vector<Tether>> slots;
  if (pins.empty()) return slots;
  const auto reached = Spreading(mesh, x, pins).run();
  std::vector<char> pinned(x.size(), 0);
  for (const int pin : pins) pinned[std::size_t(pin)] = 1;
  for (std::size_t p = 0; p < x.size(); ++p)
    for (std::size_t n = 0; !pinned[p] && n < reached[p].size(); ++n)
      add_tether(slots, int(x.size()), int(p), reached[p][n]);
  return slots;
}

}  // namespace weft::physics
