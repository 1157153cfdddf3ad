// What a mesh must be to be cloth (faces.h).
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "scene/mesh/faces.h"
#include "weft/vec3.h"

namespace weft::text {
namespace {

constexpr double kFlat = 1e-6;  // of an edge; a triangle that is lower has no area

std::string times_words(int n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

// The sides of all triangles, those of one edge next to each other.
struct Side {
  int low, high;  // vertices
  int triangle;
  bool upward;  // goes from low to high
};
std::vector<Side> sides_of(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), int(t), a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

bool same_edge(const Side& a, const Side& b) {
  return a.low == b.low && a.high == b.high;
}

// Twice the signed area of a corner of a polygon, seen along its normal.
double turn_at(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  return dot(cross(minus(b, a), minus(c, b)), normal);
}

class Repair {
 public:
  explicit Repair(RawMesh& raw) : raw_(raw), mesh_(raw.file.mesh) {}

  void run() {
    drop_doubles();
    find_flat();
    find_crowded();
    if (!raw_.file.faults.empty()) return;
    turn_over();
    keep_loose();
    tell_of_loose();
  }

 private:
  int line(int triangle) const { return raw_.lines[std::size_t(triangle)]; }

  // Triangles of the same three vertices, whichever way round.
  void drop_doubles() {
    std::vector<int> order(mesh_.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](int t) {
      std::array<int, 3> sorted = mesh_.triangles[std::size_t(t)];
      std::sort(sorted.begin(), sorted.end());
      return sorted;
    };
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    std::vector<bool> doubled(order.size());
    int count = 0, first = -1;
    for (std::size_t n = 1; n < order.size(); ++n)
      if (key(order[n]) == key(order[n - 1])) {
        doubled[std::size_t(order[n])] = true;
        if (first < 0 || order[n] < first) first = order[n];
        ++count;
      }
    if (count == 0) return;
    raw_.note(times_words(count, "triangle is", "triangles are") + " given twice, first in " +
              raw_.where(line(first)) + "; each counts once");
    keep(doubled);
  }

  void keep(const std::vector<bool>& dropped) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < dropped.size(); ++t) {
      if (dropped[t]) continue;
      mesh_.triangles[kept] = mesh_.triangles[t];
      if (!mesh_.uv.empty()) mesh_.uv[kept] = mesh_.uv[t];
      raw_.lines[kept++] = raw_.lines[t];
    }
    mesh_.triangles.resize(kept);
    if (!mesh_.uv.empty()) mesh_.uv.resize(kept);
    raw_.lines.resize(kept);
  }

  void find_flat() {
    for (std::size_t t = 0; t < mesh_.triangles.size() && !raw_.full(); ++t) {
      const auto& [a, b, c] = mesh_.triangles[t];
      const Vec3 u = minus(at(b), at(a)), v = minus(at(c), at(a)), w = minus(at(c), at(b));
      const Vec3 n = cross(u, v);
      const double longest = std::max({dot(u, u), dot(v, v), dot(w, w)});
      if (!(length(n) > kFlat * longest))
        raw_.fault(line(int(t)), "the triangle of vertices " + corners(int(t)) + " has no area",
                   "three corners that are not in line");
    }
  }

  // Edges of more than two triangles.
  void find_crowded() {
    const std::vector<Side> sides = sides_of(mesh_);
    for (std::size_t n = 0; n < sides.size() && !raw_.full();) {
      std::size_t end = n + 1;
      while (end < sides.size() && same_edge(sides[n], sides[end])) ++end;
      if (end - n > 2)
        raw_.fault(line(sides[n + 2].triangle),
                   "the edge from vertex " + number(sides[n].low) + " to " + number(sides[n].high) +
                       " has " + std::to_string(end - n) + " triangles",
                   "one or two");
      n = end;
    }
  }

  // Neighbours go along their common edge in opposite directions.
  void turn_over() {
    std::vector<std::vector<std::pair<int, bool>>> beside(mesh_.triangles.size());
    const std::vector<Side> sides = sides_of(mesh_);
    for (std::size_t n = 1; n < sides.size(); ++n)
      if (same_edge(sides[n - 1], sides[n])) {
        const bool alike = sides[n - 1].upward == sides[n].upward;
        beside[std::size_t(sides[n].triangle)].push_back({sides[n - 1].triangle, alike});
        beside[std::size_t(sides[n - 1].triangle)].push_back({sides[n].triangle, alike});
      }
    std::vector<int> turned(beside.size(), -1), piece;
    int count = 0, first = -1;
    bool two_sided = true;
    for (std::size_t t = 0; t < beside.size(); ++t) {
      if (turned[t] >= 0) continue;
      piece.assign(1, int(t));
      turned[t] = 0;
      std::size_t ones = 0;
      for (std::size_t n = 0; n < piece.size(); ++n)
        for (const auto& [next, alike] : beside[std::size_t(piece[n])]) {
          int& there = turned[std::size_t(next)];
          const int as = turned[std::size_t(piece[n])] ^ int(alike);
          if (there < 0)
            there = as, ones += std::size_t(as), piece.push_back(next);
          else
            two_sided &= there == as;
        }
      const int minority = 2 * ones > piece.size() ? 0 : 1;
      for (const int p : piece)
        if (turned[std::size_t(p)] == minority) {
          turn(p);
          ++count;
          if (first < 0 || p < first) first = p;
        }
    }
    if (!two_sided)
      raw_.note("the surface has one side only (a Moebius band); its normals jump somewhere");
    else if (count > 0)
      raw_.note(times_words(count, "triangle is", "triangles are") +
                " turned over to agree with the others, first in " + raw_.where(line(first)));
  }

  void turn(int t) {
    std::swap(mesh_.triangles[std::size_t(t)][1], mesh_.triangles[std::size_t(t)][2]);
    if (!mesh_.uv.empty()) std::swap(mesh_.uv[std::size_t(t)][1], mesh_.uv[std::size_t(t)][2]);
  }

  // Of the lines that the file draws, those that are no side of a face.
  void keep_loose() {
    const std::vector<Side> sides = sides_of(mesh_);
    std::erase_if(mesh_.edges, [&](const std::array<int, 2>& edge) {
      const Side one{std::min(edge[0], edge[1]), std::max(edge[0], edge[1]), 0, true};
      return std::binary_search(sides.begin(), sides.end(), one, [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high) < std::tie(b.low, b.high);
      });
    });
  }

  void tell_of_loose() {
    std::vector<bool> used(mesh_.vertices.size());
    for (const auto& t : mesh_.triangles)
      for (const int p : t) used[std::size_t(p)] = true;
    const auto loose = std::count(used.begin(), used.end(), false);
    if (loose > 0)
      raw_.note(times_words(int(loose), "vertex belongs", "vertices belong") +
                " to no face, first vertex " +
                number(int(std::find(used.begin(), used.end(), false) - used.begin())) +
                "; what has no face has no mass and stays where it is");
  }

  const Vec3& at(int vertex) const { return mesh_.vertices[std::size_t(vertex)]; }
  std::string corners(int t) const {
    const auto& [a, b, c] = mesh_.triangles[std::size_t(t)];
    return number(a) + ", " + number(b) + " and " + number(c);
  }
  std::string number(int vertex) const { return std::to_string(vertex + raw_.first_vertex); }

  RawMesh& raw_;
  TriangleMesh& mesh_;
};

}  // namespace

void RawMesh::fault(int line, std::string what, std::string allowed) const {
  if (full()) return;
  const std::string place = line <= 0 ? name
                            : words   ? name + ", " + words(line)
                                      : name + ":" + std::to_string(line);
  file.faults.push_back({place, std::move(what), std::move(allowed)});
}

std::vector<std::array<int, 3>> triangles_of(const std::vector<Vec3>& corners, bool* crosses) {
  std::vector<int> left(corners.size());
  std::iota(left.begin(), left.end(), 0);
  Vec3 normal{};  // Newell's
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 n =
        cross(minus(corners[k], corners[0]), minus(corners[(k + 1) % corners.size()], corners[0]));
    for (std::size_t c = 0; c < 3; ++c) normal[c] += n[c];
  }
  const auto corner = [&](std::size_t k) { return corners[std::size_t(left[k % left.size()])]; };
  // Whether corner k can be cut off: it is convex, and no other corner lies in its triangle.
  const auto is_ear = [&](std::size_t k) {
    const std::size_t n = left.size();
    const Vec3 a = corner(k + n - 1), b = corner(k), c = corner(k + 1);
    if (!(turn_at(a, b, c, normal) > 0)) return false;
    for (std::size_t q = k + 2; q < k + n - 1; ++q) {
      const Vec3 p = corner(q);
      if (turn_at(a, b, p, normal) >= 0 && turn_at(b, c, p, normal) >= 0 &&
          turn_at(c, a, p, normal) >= 0)
        return false;
    }
    return true;
  };
  std::vector<std::array<int, 3>> triangles;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    std::size_t best = n;
    double shortest = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 across = minus(corner(k + 1), corner(k + n - 1));
      if (!is_ear(k) || (best < n && !(dot(across, across) < shortest))) continue;
      best = k;
      shortest = dot(across, across);
    }
    if (best == n && crosses) *crosses = true;
    best %= n;  // of a polygon that crosses itself: any
    triangles.push_back({left[(best + n - 1) % n], left[best], left[(best + 1) % n]});
    left.erase(left.begin() + std::ptrdiff_t(best));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

void repair(RawMesh& mesh) {
  Repair(mesh).run();
}

}  // namespace weft::text
