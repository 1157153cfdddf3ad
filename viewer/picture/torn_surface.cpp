// The surface of a torn cloth: splines end at the tear, normals are those of the triangles that are
// left, and a square with one triangle left is drawn as that triangle.
#include "picture/surface.h"

namespace weft::viewer {

namespace {

std::size_t size(int n) {
  return static_cast<std::size_t>(n);
}

// What is left of every square of the grid: bit 1 the triangle at its corner (i,j), bit 2 the one
// at its corner (i+1,j+1).
class Squares {
 public:
  explicit Squares(const ClothCopy& cloth)
      : columns_(cloth.columns - 1), rows_(cloth.rows - 1), left_(size(columns_) * size(rows_)) {
    for (const auto& t : cloth.triangles) {
      const bool first = t[2] == t[0] + static_cast<std::uint32_t>(cloth.stride);
      const std::uint32_t p = first ? t[0] : t[0] - 1;
      const std::size_t i = p % size(cloth.stride), j = p / size(cloth.stride);
      left_[j * size(columns_) + i] |= first ? 1 : 2;
    }
  }

  int at(int i, int j) const {
    const bool inside = i >= 0 && j >= 0 && i < columns_ && j < rows_;
    return inside ? left_[size(j) * size(columns_) + size(i)] : 0;
  }
  // Whether a triangle holds particle (i,j) to (i+1,j), or to (i,j+1).
  bool along(int i, int j) const { return (at(i, j) & 1) != 0 || (at(i, j - 1) & 2) != 0; }
  bool across(int i, int j) const { return (at(i, j) & 1) != 0 || (at(i - 1, j) & 2) != 0; }

 private:
  int columns_, rows_;
  std::vector<std::uint8_t> left_;
};

// Catmull-Rom between b and c; a and d are straight on where they are missing.
float spline(float a, bool has_a, float b, float c, float d, bool has_d, float t) {
  if (!has_a) a = 2 * b - c;
  if (!has_d) d = 2 * c - b;
  const float t2 = t * t, t3 = t2 * t;
  return 0.5f * ((-t3 + 2 * t2 - t) * a + (3 * t3 - 5 * t2 + 2) * b + (-3 * t3 + 4 * t2 + t) * c +
                 (t3 - t2) * d);
}

void refine(const std::vector<float>& from, const ClothCopy& cloth, const Squares& squares, int r,
            std::vector<float>& to) {
  const int columns = (cloth.columns - 1) * r + 1;
  to.resize(size(columns) * size((cloth.rows - 1) * r + 1));
  const auto out = [&](int c, int j) -> float& { return to[size(j) * size(columns) + size(c)]; };
  for (int j = 0; j < cloth.rows; ++j) {
    const auto at = [&](int i) { return from[cloth.at(i, j)]; };
    for (int c = 0; c < columns - 1; ++c) {
      const int i = c / r;
      const bool before = i > 0 && squares.along(i - 1, j);
      const bool after = i + 2 < cloth.columns && squares.along(i + 1, j);
      out(c, j * r) =
          spline(before ? at(i - 1) : 0, before, at(i), at(i + 1), after ? at(i + 2) : 0, after,
                 static_cast<float>(c % r) / static_cast<float>(r));
    }
    out(columns - 1, j * r) = at(cloth.columns - 1);
  }
  for (int j = 0; j + 1 < cloth.rows; ++j)
    for (int c = 0; c < columns && r > 1; ++c) {
      const int i = std::min(c / r, cloth.columns - 2);
      const auto held = [&](int row) {
        return row >= 0 && row + 1 < cloth.rows &&
               squares.across(c == columns - 1 ? i + 1 : i, row) &&
               (c % r == 0 || squares.across(i + 1, row));
      };
      const bool before = held(j - 1), after = held(j + 1);
      for (int s = 1; s < r; ++s)
        out(c, j * r + s) = spline(before ? out(c, (j - 1) * r) : 0, before, out(c, j * r),
                                   out(c, (j + 1) * r), after ? out(c, (j + 2) * r) : 0, after,
                                   static_cast<float>(s) / static_cast<float>(r));
    }
}

void add_normals(ClothSurface& s) {
  for (auto* n : {&s.nx, &s.ny, &s.nz}) n->assign(s.x.size(), 0);
  for (std::size_t k = 0; k < s.indices.size(); k += 3) {
    const std::size_t a = s.indices[k], b = s.indices[k + 1], c = s.indices[k + 2];
    if (a == b) continue;
    const auto at = [&](std::size_t p) { return Vec3f{s.x[p], s.y[p], s.z[p]}; };
    const Vec3f n = cross(at(b) - at(a), at(c) - at(a));
    for (const std::size_t p : {a, b, c}) {
      s.nx[p] += n.x;
      s.ny[p] += n.y;
      s.nz[p] += n.z;
    }
  }
}

}  // namespace

void triangulate(const ClothCopy& cloth, ClothSurface& surface) {
  if (cloth.mesh) {
    surface.indices.clear();
    for (const auto& t : cloth.triangles)
      surface.indices.insert(surface.indices.end(), t.begin(), t.end());
    return;
  }
  const Squares squares(cloth);
  const int r = surface.refinement, columns = surface.columns;
  std::vector<std::uint32_t>& indices = surface.indices;
  indices.clear();
  indices.reserve(6 * size(columns - 1) * size(surface.rows - 1));
  const auto vertex = [&](int c, int j) { return static_cast<std::uint32_t>(j * columns + c); };
  for (int j = 0; j + 1 < cloth.rows; ++j)
    for (int i = 0; i + 1 < cloth.columns; ++i) {
      const int left = cloth.torn ? squares.at(i, j) : 3;
      const std::size_t end = indices.size() + 6 * size(r) * size(r);
      const std::uint32_t corners[4] = {vertex(i * r, j * r), vertex((i + 1) * r, j * r),
                                        vertex(i * r, (j + 1) * r),
                                        vertex((i + 1) * r, (j + 1) * r)};
      if (left == 1) indices.insert(indices.end(), {corners[0], corners[1], corners[2]});
      if (left == 2) indices.insert(indices.end(), {corners[1], corners[3], corners[2]});
      for (int n = 0; n < r * r && left == 3; ++n) {
        const std::uint32_t a = vertex(i * r + n % r, j * r + n / r);
        const std::uint32_t below = a + static_cast<std::uint32_t>(columns);
        indices.insert(indices.end(), {a, a + 1, below, a + 1, below + 1, below});
      }
      indices.resize(end, corners[0]);  // what is gone is drawn as a point, that is, not at all
    }
}

std::size_t vertex_of(const ClothCopy& cloth, const ClothSurface& surface, std::uint32_t particle) {
  const std::size_t i = particle % size(cloth.stride), j = particle / size(cloth.stride);
  return (j * size(surface.columns) + i) * size(surface.refinement);
}

// A point has the force and strain of its particle, and of the normal a share of its own triangles.
void add_tear_boundary(const ClothCopy& cloth, ClothSurface& s) {
  const std::size_t first = s.x.size(), count = cloth.tear_points.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t v = vertex_of(cloth, s, cloth.tear_particles[k]);
    const auto& [x, y, z] = cloth.tear_points[k];
    s.x.push_back(x), s.y.push_back(y), s.z.push_back(z);
    for (auto* values : {&s.nx, &s.ny, &s.nz, &s.fx, &s.fy, &s.fz, &s.strain})
      if (!values->empty()) values->push_back((*values)[v]);
  }
  s.tear_indices.clear();
  for (const auto& [a, b, c] : cloth.tear_triangles) {
    const auto at = [&](std::size_t p) {
      return Vec3f{s.x[first + p], s.y[first + p], s.z[first + p]};
    };
    const Vec3f n = cross(at(b) - at(a), at(c) - at(a));
    for (const std::size_t p : {a, b, c}) {
      s.nx[first + p] += n.x;
      s.ny[first + p] += n.y;
      s.nz[first + p] += n.z;
      s.tear_indices.push_back(static_cast<std::uint32_t>(first + p));
    }
  }
}

void build_mesh_surface(const ClothCopy& cloth, ClothSurface& surface) {
  surface.x = cloth.x;
  surface.y = cloth.y;
  surface.z = cloth.z;
  add_normals(surface);
}

void build_torn_surface(const ClothCopy& cloth, ClothSurface& surface) {
  const Squares squares(cloth);
  refine(cloth.x, cloth, squares, surface.refinement, surface.x);
  refine(cloth.y, cloth, squares, surface.refinement, surface.y);
  refine(cloth.z, cloth, squares, surface.refinement, surface.z);
  add_normals(surface);
}

}  // namespace weft::viewer
