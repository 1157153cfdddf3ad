#include "net.h"

#include <cstdio>
#include <map>
#include <set>
#include <stdexcept>

namespace mannequin {
namespace {

constexpr int kRelaxations = 20;

Vec gradient(const Field& field, Vec p) {
  constexpr double h = 1e-4;
  return {(field({p.x + h, p.y, p.z}) - field({p.x - h, p.y, p.z})) / (2 * h),
          (field({p.x, p.y + h, p.z}) - field({p.x, p.y - h, p.z})) / (2 * h),
          (field({p.x, p.y, p.z + h}) - field({p.x, p.y, p.z - h})) / (2 * h)};
}

class Grid {
 public:
  Grid(const Field& field, Vec low, Vec high, double cell)
      : low_(low),
        cell_(cell),
        n_{int((high.x - low.x) / cell) + 2, int((high.y - low.y) / cell) + 2,
           int((high.z - low.z) / cell) + 2} {
    values_.reserve(std::size_t(n_[0]) * std::size_t(n_[1]) * std::size_t(n_[2]));
    for (int k = 0; k < n_[2]; ++k)
      for (int j = 0; j < n_[1]; ++j)
        for (int i = 0; i < n_[0]; ++i) values_.push_back(field(at(i, j, k)));
  }

  Mesh net() {
    for (int k = 0; k + 1 < n_[2]; ++k)
      for (int j = 0; j + 1 < n_[1]; ++j)
        for (int i = 0; i + 1 < n_[0]; ++i) add_vertex(i, j, k);
    for (int k = 1; k + 1 < n_[2]; ++k)
      for (int j = 1; j + 1 < n_[1]; ++j)
        for (int i = 1; i + 1 < n_[0]; ++i)
          for (int axis = 0; axis < 3; ++axis) add_square({i, j, k}, axis);
    return std::move(mesh_);
  }

 private:
  std::size_t number(int i, int j, int k) const {
    return std::size_t(i) +
           std::size_t(n_[0]) * (std::size_t(j) + std::size_t(n_[1]) * std::size_t(k));
  }
  Vec at(double i, double j, double k) const { return low_ + Vec{i * cell_, j * cell_, k * cell_}; }

  // The mean of where the surface crosses the edges of a cell.
  void add_vertex(int i, int j, int k) {
    Vec sum;
    int count = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int corner = 0; corner < 4; ++corner) {
        std::array<int, 3> a{i, j, k};
        a[std::size_t((axis + 1) % 3)] += corner & 1;
        a[std::size_t((axis + 2) % 3)] += corner >> 1;
        std::array<int, 3> b = a;
        ++b[std::size_t(axis)];
        const double from = values_[number(a[0], a[1], a[2])],
                     to = values_[number(b[0], b[1], b[2])];
        if ((from < 0) == (to < 0)) continue;
        sum = sum + mixed(at(a[0], a[1], a[2]), at(b[0], b[1], b[2]), from / (from - to));
        ++count;
      }
    if (count == 0) return;
    vertex_[number(i, j, k)] = int(mesh_.vertices.size());
    mesh_.vertices.push_back(sum * (1.0 / count));
  }

  // About the edge of the grid from a point on along an axis, cut along the shorter diagonal.
  void add_square(std::array<int, 3> a, int axis) {
    std::array<int, 3> b = a;
    ++b[std::size_t(axis)];
    const double from = values_[number(a[0], a[1], a[2])], to = values_[number(b[0], b[1], b[2])];
    if ((from < 0) == (to < 0)) return;
    std::array<int, 4> square{};
    for (int corner = 0; corner < 4; ++corner) {
      std::array<int, 3> cell = a;
      cell[std::size_t((axis + 1) % 3)] -= corner == 0 || corner == 3;
      cell[std::size_t((axis + 2) % 3)] -= corner < 2;
      square[std::size_t(corner)] = vertex_.at(number(cell[0], cell[1], cell[2]));
    }
    if (from > 0) std::swap(square[1], square[3]);
    const auto& [p, q, r, s] = square;
    const auto apart = [&](int m, int n) {
      return length(mesh_.vertices[std::size_t(m)] - mesh_.vertices[std::size_t(n)]);
    };
    if (apart(p, r) < apart(q, s)) {
      mesh_.triangles.push_back({p, q, r});
      mesh_.triangles.push_back({p, r, s});
    } else {
      mesh_.triangles.push_back({p, q, s});
      mesh_.triangles.push_back({q, r, s});
    }
  }

  Vec low_;
  double cell_;
  std::array<int, 3> n_;
  std::vector<double> values_;
  std::map<std::size_t, int> vertex_;  // by cell
  Mesh mesh_;
};

std::vector<std::set<int>> neighbours(const Mesh& mesh) {
  std::vector<std::set<int>> beside(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      beside[std::size_t(t[k])].insert(t[(k + 1) % 3]);
      beside[std::size_t(t[k])].insert(t[(k + 2) % 3]);
    }
  return beside;
}

// Towards the mean of the neighbours, along the surface; what is held stays.
void relax(Mesh& mesh, const Field& field, int times, const std::vector<bool>& held) {
  const auto beside = neighbours(mesh);
  for (int n = 0; n < times; ++n) {
    std::vector<Vec> next = mesh.vertices;
    for (std::size_t v = 0; v < next.size(); ++v) {
      if (beside[v].empty() || (!held.empty() && held[v])) continue;
      Vec mean;
      for (const int other : beside[v]) mean = mean + mesh.vertices[std::size_t(other)];
      mean = mean * (1.0 / double(beside[v].size()));
      const Vec g = gradient(field, next[v]), normal = unit(g), way = mean - next[v];
      const Vec p = next[v] + (way - normal * dot(way, normal)) * 0.5;
      next[v] = p - g * (field(p) / std::max(dot(g, g), 0.1));
    }
    mesh.vertices = std::move(next);
  }
}

// The edges of one triangle, by their ends.
std::set<std::pair<int, int>> border(const Mesh& mesh) {
  std::set<std::pair<int, int>> open;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = std::minmax(t[k], t[(k + 1) % 3]);
      if (!open.insert({edge.first, edge.second}).second) open.erase({edge.first, edge.second});
    }
  return open;
}

// Whether no edge has more than two triangles: two sheets that pass one cell share its vertex.
bool has_one_side(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> count;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = std::minmax(t[k], t[(k + 1) % 3]);
      if (++count[{edge.first, edge.second}] > 2) return false;
    }
  return true;
}

}  // namespace

Vec put_on(const Field& field, Vec p) {
  for (int n = 0; n < 4; ++n) {
    const Vec g = gradient(field, p);
    p = p - g * (field(p) / std::max(dot(g, g), 0.1));
  }
  return p;
}

Mesh surface_of(const Field& field, Vec low, Vec high, double cell) {
  constexpr int kTries = 16;  // of where the grid lies
  Mesh mesh;
  for (int n = 0; n < kTries && (n == 0 || !has_one_side(mesh)); ++n)
    mesh = largest_piece(Grid(field, low - Vec{0, 0.37, 0.61} * (n * cell), high, cell).net());
  if (!has_one_side(mesh)) throw std::runtime_error("two parts of a surface meet in one cell");
  for (Vec& p : mesh.vertices) p = put_on(field, p);
  relax(mesh, field, kRelaxations, {});
  return mesh;
}

Mesh cut(const Mesh& mesh, const Field& field, const Field& kept) {
  Mesh left{mesh.vertices, {}};
  for (const auto& t : mesh.triangles) {
    Vec middle;
    for (const int v : t) middle = middle + mesh.vertices[std::size_t(v)] * (1.0 / 3);
    if (kept(middle) < 0) left.triangles.push_back(t);
  }
  left = largest_piece(left);
  // What hangs on by one corner of a border is no cloth: triangles with two free sides are left out.
  for (int n = 0; n < 3; ++n) {
    const auto open = border(left);
    std::erase_if(left.triangles, [&](const auto& t) {
      int free = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto edge = std::minmax(t[k], t[(k + 1) % 3]);
        free += open.contains({edge.first, edge.second});
      }
      return free > 1;
    });
    left = largest_piece(left);
  }
  std::vector<bool> held(left.vertices.size());
  for (const auto& [a, b] : border(left)) held[std::size_t(a)] = held[std::size_t(b)] = true;
  for (int n = 0; n < kRelaxations; ++n) {
    for (std::size_t v = 0; v < held.size(); ++v)
      for (int m = 0; held[v] && m < 3; ++m)
        left.vertices[v] = put_on(field, put_on(kept, left.vertices[v]));
    relax(left, field, 1, held);
  }
  return left;
}

Mesh largest_piece(const Mesh& mesh) {
  std::vector<int> piece(mesh.vertices.size());
  for (std::size_t v = 0; v < piece.size(); ++v) piece[v] = int(v);
  const auto of = [&](int v) {
    while (piece[std::size_t(v)] != v)
      v = piece[std::size_t(v)] = piece[std::size_t(piece[std::size_t(v)])];
    return v;
  };
  for (const auto& t : mesh.triangles)
    for (const int v : t) piece[std::size_t(of(v))] = of(t[0]);
  std::map<int, int> sizes;
  for (const auto& t : mesh.triangles) ++sizes[of(t[0])];
  int largest = -1;
  for (const auto& [root, size] : sizes)
    if (largest < 0 || size > sizes[largest]) largest = root;
  Mesh left;
  std::map<int, int> number;
  for (const auto& t : mesh.triangles) {
    if (of(t[0]) != largest) continue;
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [known, added] = number.try_emplace(t[k], int(left.vertices.size()));
      if (added) left.vertices.push_back(mesh.vertices[std::size_t(t[k])]);
      corners[k] = known->second;
    }
    left.triangles.push_back(corners);
  }
  return left;
}

void write_obj(const Mesh& mesh, const std::string& path, const std::string& name) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (!file) throw std::runtime_error(path + ": cannot be written");
  std::fprintf(file, "o %s\n", name.c_str());
  for (const Vec& p : mesh.vertices) std::fprintf(file, "v %.5f %.5f %.5f\n", p.x, p.y, p.z);
  for (const auto& [a, b, c] : mesh.triangles)
    std::fprintf(file, "f %d %d %d\n", a + 1, b + 1, c + 1);
  if (std::fclose(file) != 0) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace mannequin
