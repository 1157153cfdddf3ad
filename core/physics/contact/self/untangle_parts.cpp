// Sheets that pass through each other (untangle.h): the lines along which they meet, and the part of each that
// passes.
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "physics/contact/self/untangle.h"
#include "physics/model/lattice/stages.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

constexpr std::size_t kMostOfLine = 1 << 15;  // particles that are looked at
// Times the area that it has: of a pinned particle, and of one that is an end of a crossing edge, too.
constexpr double kPinned = 100, kPinnedEnd = 1e6;

// Disjoint sets of the numbers from 0 (Tarjan 1975); the least of a set stands for it.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  std::int32_t of(std::int32_t n) {
    while (parent_[std::size_t(n)] != n) {
      std::int32_t& up = parent_[std::size_t(n)];
      up = parent_[std::size_t(up)];
      n = up;
    }
    return n;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = of(a), b = of(b);
    parent_[std::size_t(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<std::int32_t> parent_;
};

}  // namespace

// Crossings along one line where sheets meet: from an edge through a triangle the line goes on to the
// other edges of the edge's triangles, or to those of that triangle.
void Untangle::find_lines() {
  Sets lines(crossings_.size());
  const auto share = [](const Edge& a, const Edge& b) {
    return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
  };
  std::vector<std::int32_t> by_face(crossings_.size());
  std::iota(by_face.begin(), by_face.end(), 0);
  const auto crossing = [&](std::int32_t k) { return crossings_[std::size_t(k)]; };
  std::ranges::stable_sort(by_face, {}, [&](std::int32_t k) { return crossing(k).face; });
  for (auto a = by_face.begin(); a != by_face.end(); ++a)
    for (auto b = a + 1; b != by_face.end() && crossing(*b).face == crossing(*a).face; ++b)
      if (share(crossing(*a).edge, crossing(*b).edge)) lines.join(*a, *b);
  for (std::size_t k = 0; k < crossings_.size(); ++k) {
    const Crossing& c = crossings_[k];
    const Face& f = faces_[std::size_t(c.face)];
    for (int side = 0; side < 3; ++side) {
      const std::int32_t a = f[side], b = f[(side + 1) % 3];
      const Edge edge{std::min(a, b), std::max(a, b)};
      for (auto other = std::ranges::lower_bound(crossings_, edge, {}, &Crossing::edge);
           other != crossings_.end() && other->edge == edge; ++other) {
        const Face& through = faces_[std::size_t(other->face)];
        const auto has = [&](std::int32_t n) {
          return std::find(through.begin(), through.end(), n) != through.end();
        };
        if (has(c.edge[0]) && has(c.edge[1]))
          lines.join(std::int32_t(k), std::int32_t(other - crossings_.begin()));
      }
    }
  }
  line_.resize(crossings_.size());
  for (std::size_t k = 0; k < line_.size(); ++k) line_[k] = lines.of(std::int32_t(k));
}

// The ends of crossing edges, by particle and line, each once.
void Untangle::list_ends() {
  ends_.clear();
  for (std::size_t k = 0; k < crossings_.size(); ++k) {
    const Face& f = faces_[std::size_t(crossings_[k].face)];
    const Vec3 normal = normal_of(at(f[0]), at(f[1]), at(f[2]));
    for (const std::int32_t end : crossings_[k].edge)
      ends_.push_back({end, line_[k], dot(normal, minus(at(end), at(f[0]))) > 0, 0, false});
  }
  const auto place = [](const End& e) { return std::pair(e.particle, e.line); };
  std::ranges::stable_sort(ends_, {}, place);
  const auto same = [&](const End& a, const End& b) { return place(a) == place(b); };
  ends_.erase(std::unique(ends_.begin(), ends_.end(), same), ends_.end());
}

// Of every line, the part that is least.
void Untangle::choose_parts() {
  find_lines();
  list_ends();
  std::vector<Edge> crossing;
  for (const Crossing& c : crossings_) crossing.push_back(c.edge);
  whole_.clear();
  std::set_difference(edges_.begin(), edges_.end(), crossing.begin(), crossing.end(),
                      std::back_inserter(whole_));
  // Ends of one line on one side that are neighbours begin one part.
  Sets parts(ends_.size());
  for (const auto& [a, b] : edges_)
    for (std::size_t n = first_end(a); n < ends_.size() && ends_[n].particle == a; ++n)
      for (std::size_t m = first_end(b); m < ends_.size() && ends_[m].particle == b; ++m)
        if (ends_[n].line == ends_[m].line && ends_[n].front == ends_[m].front)
          parts.join(std::int32_t(n), std::int32_t(m));
  for (std::size_t n = 0; n < ends_.size(); ++n) ends_[n].part = parts.of(std::int32_t(n));
  list_neighbours();
  std::vector<std::int32_t> order(ends_.size());
  std::iota(order.begin(), order.end(), 0);
  const auto line_of = [&](std::int32_t n) { return ends_[std::size_t(n)].line; };
  std::ranges::stable_sort(order, {}, line_of);
  part_.assign(x_.size(), -1);
  for (auto begin = order.begin(); begin != order.end();) {
    const std::int32_t line = line_of(*begin);
    const auto end =
        std::find_if(begin, order.end(), [&](std::int32_t n) { return line_of(n) != line; });
    choose_part({begin, end});
    begin = end;
  }
}

// Every particle belongs to the part of the line's end that is the fewest edges away, as far as that is
// looked at.
void Untangle::choose_part(std::span<const std::int32_t> ends) {
  reached_.clear();
  for (const std::int32_t n : ends) {
    const End& end = ends_[std::size_t(n)];
    part_[std::size_t(end.particle)] = end.part;
    reached_.push_back(end.particle);
  }
  for (std::size_t k = 0; k < reached_.size() && reached_.size() < kMostOfLine; ++k) {
    const auto n = std::size_t(reached_[k]);
    for (std::size_t at = first_[n]; at < first_[n + 1]; ++at) {
      std::int32_t& part = part_[std::size_t(neighbours_[at])];
      if (part >= 0) continue;
      part = part_[n];
      reached_.push_back(neighbours_[at]);
    }
  }
  std::map<std::int32_t, double> areas;
  for (const std::int32_t n : reached_) areas[part_[std::size_t(n)]] += area(n, kPinned);
  for (const std::int32_t n : ends) {
    const End& end = ends_[std::size_t(n)];
    areas[end.part] += area(end.particle, kPinnedEnd);
  }
  const auto least = std::min_element(areas.begin(), areas.end(), [](const auto& a, const auto& b) {
                       return a.second < b.second;
                     })->first;
  for (const std::int32_t n : ends)
    ends_[std::size_t(n)].passes = ends_[std::size_t(n)].part == least;
  for (const std::int32_t n : reached_) {
    passing_[std::size_t(n)] |= part_[std::size_t(n)] == least;
    part_[std::size_t(n)] = -1;
  }
}

// Of a particle [m²], so many times where it is pinned.
double Untangle::area(std::int32_t particle, double pinned) const {
  return sheet_of(particle).area * (inverse_mass(particle) > 0 ? 1 : pinned);
}

std::size_t Untangle::first_end(std::int32_t particle) const {
  return std::size_t(std::ranges::lower_bound(ends_, particle, {}, &End::particle) - ends_.begin());
}

// By edges that do not cross.
void Untangle::list_neighbours() {
  first_.assign(x_.size() + 1, 0);
  for (const Edge& e : whole_)
    for (const std::int32_t end : e) ++first_[std::size_t(end) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  neighbours_.resize(2 * whole_.size());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const auto& [a, b] : whole_) {
    neighbours_[next[std::size_t(a)]++] = b;
    neighbours_[next[std::size_t(b)]++] = a;
  }
}

}  // namespace weft::physics
