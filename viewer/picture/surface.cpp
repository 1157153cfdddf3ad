// Refinement: Catmull-Rom splines (Catmull and Rom 1974), first along the rows, then across them.
#include "picture/surface.h"

#include "weft/mesh.h"

namespace weft::viewer {

namespace {

std::size_t count(int columns, int rows) {
  return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
}

// Weights of the four particles around a point t of the way through the middle span.
struct Weights {
  float a, b, c, d;
};
Weights weights_at(float t) {
  const float t2 = t * t, t3 = t2 * t;
  return {0.5f * (-t3 + 2 * t2 - t), 0.5f * (3 * t3 - 5 * t2 + 2), 0.5f * (-3 * t3 + 4 * t2 + t),
          0.5f * (t3 - t2)};
}

// The row `from` of n values, refined r times; beyond its ends it goes on straight.
void refine_row(const float* from, int n, int r, float* to) {
  for (int s = 0; s < r; ++s) {
    const Weights w = weights_at(static_cast<float>(s) / static_cast<float>(r));
    for (int i = 0; i + 1 < n; ++i) {
      const float before = i > 0 ? from[i - 1] : 2 * from[0] - from[1];
      const float after = i + 2 < n ? from[i + 2] : 2 * from[n - 1] - from[n - 2];
      to[i * r + s] = w.a * before + w.b * from[i] + w.c * from[i + 1] + w.d * after;
    }
  }
  to[(n - 1) * r] = from[n - 1];
}

// Refines a padded component array into an unpadded one.
void refine(const std::vector<float>& from, const ClothCopy& cloth, int r, std::vector<float>& to) {
  const int columns = (cloth.columns - 1) * r + 1, rows = (cloth.rows - 1) * r + 1;
  to.resize(count(columns, rows));
  const auto row = [&](int j) { return to.data() + count(columns, j); };
  for (int j = 0; j < cloth.rows; ++j)
    refine_row(from.data() + cloth.at(0, j), cloth.columns, r, row(j * r));
  if (r == 1) return;
  std::vector<float> first(static_cast<std::size_t>(columns)), last = first;
  const float *top = row(0), *top2 = row(r);
  const float *end = row((cloth.rows - 1) * r), *end2 = row((cloth.rows - 2) * r);
  for (int i = 0; i < columns; ++i) {
    first[static_cast<std::size_t>(i)] = 2 * top[i] - top2[i];
    last[static_cast<std::size_t>(i)] = 2 * end[i] - end2[i];
  }
  for (int j = 0; j + 1 < cloth.rows; ++j) {
    const float* a = j > 0 ? row((j - 1) * r) : first.data();
    const float *b = row(j * r), *c = row((j + 1) * r);
    const float* d = j + 2 < cloth.rows ? row((j + 2) * r) : last.data();
    for (int s = 1; s < r; ++s) {
      const Weights w = weights_at(static_cast<float>(s) / static_cast<float>(r));
      float* out = row(j * r + s);
      for (int i = 0; i < columns; ++i) out[i] = w.a * a[i] + w.b * b[i] + w.c * c[i] + w.d * d[i];
    }
  }
}

// n = (p(i+1,j) - p(i-1,j)) x (p(i,j+1) - p(i,j-1)), one-sided at the borders.
void compute_normals(ClothSurface& s) {
  const int columns = s.columns;
  for (auto* n : {&s.nx, &s.ny, &s.nz}) n->resize(count(columns, s.rows));
  for (int j = 0; j < s.rows; ++j) {
    const std::size_t here = count(columns, j);
    const std::size_t up = count(columns, std::max(j - 1, 0));
    const std::size_t down = count(columns, std::min(j + 1, s.rows - 1));
    const auto normal = [&](int i, int left, int right) {
      const std::size_t a = here + static_cast<std::size_t>(left);
      const std::size_t b = here + static_cast<std::size_t>(right);
      const std::size_t c = up + static_cast<std::size_t>(i),
                        d = down + static_cast<std::size_t>(i);
      const float ux = s.x[b] - s.x[a], uy = s.y[b] - s.y[a], uz = s.z[b] - s.z[a];
      const float wx = s.x[d] - s.x[c], wy = s.y[d] - s.y[c], wz = s.z[d] - s.z[c];
      const std::size_t at = here + static_cast<std::size_t>(i);
      s.nx[at] = uy * wz - uz * wy;
      s.ny[at] = uz * wx - ux * wz;
      s.nz[at] = ux * wy - uy * wx;
    };
    normal(0, 0, 1);
    for (int i = 1; i + 1 < columns; ++i) normal(i, i - 1, i + 1);
    normal(columns - 1, columns - 2, columns - 1);
  }
}

// A value per particle, straight between them on the refined lattice of the thinned cloth.
void spread(const std::vector<float>& values, const ClothCopy& cloth, int step,
            const ClothSurface& surface, std::vector<float>& to) {
  const std::vector<float> from = thinned(values, cloth, step);
  const int r = surface.refinement, columns = surface.columns, rows = surface.rows;
  const int across = (columns - 1) / r + 1, down = (rows - 1) / r + 1;
  to.resize(count(columns, rows));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int i0 = std::min(i / r, across - 2), j0 = std::min(j / r, down - 2);
      const float s = static_cast<float>(i - i0 * r) / static_cast<float>(r);
      const float t = static_cast<float>(j - j0 * r) / static_cast<float>(r);
      const std::size_t a = count(across, j0) + static_cast<std::size_t>(i0);
      const std::size_t b = a + static_cast<std::size_t>(across);
      to[count(columns, j) + static_cast<std::size_t>(i)] =
          (1 - t) * ((1 - s) * from[a] + s * from[a + 1]) +
          t * ((1 - s) * from[b] + s * from[b + 1]);
    }
}

float rest_length(const Grid& grid, Offset o) {
  const Vec3f u = to_float(grid.u) * (1 / static_cast<float>(grid.nx - 1));
  const Vec3f v = to_float(grid.v) * (1 / static_cast<float>(grid.ny - 1));
  return length(u * static_cast<float>(o.di) + v * static_cast<float>(o.dj));
}

// Calls link(a, b) for every pair of particles that differ by the offset.
template <class Link>
void each_link(const ClothCopy& cloth, Offset o, Link link) {
  for (int j = std::max(0, -o.dj); j < cloth.rows - std::max(0, o.dj); ++j)
    for (int i = 0; i < cloth.columns - o.di; ++i)
      link(cloth.at(i, j), cloth.at(i + o.di, j + o.dj));
}

void add_mesh_strains(const ClothCopy& cloth, const Cloth& description,
                      std::vector<float>& strain) {
  strain.assign(cloth.x.size(), 0);
  const std::vector<Vec3> rest = placed_vertices(description.mesh);
  for (const auto& [a, b] : edges_of(cloth)) {
    const Vec3f now = cloth.position(static_cast<int>(b)) - cloth.position(static_cast<int>(a));
    const float e = std::abs(length(now) / length(to_float(rest[b]) - to_float(rest[a])) - 1);
    strain[a] = std::max(strain[a], e);
    strain[b] = std::max(strain[b], e);
  }
}

}  // namespace

std::vector<std::array<std::uint32_t, 2>> edges_of(const ClothCopy& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

double spacing_of(const Cloth& cloth) {
  if (!cloth.mesh.given()) return std::max(spacing_u(cloth.grid), spacing_v(cloth.grid));
  constexpr std::size_t kLooked = 500;  // triangles
  const TriangleMesh& mesh = *cloth.mesh.shape;
  const std::size_t step = mesh.triangles.size() / kLooked + 1;
  double sum = 0, count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += step)
    for (std::size_t k = 0; k < 3; ++k, ++count) {
      const Vec3& a = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
      const Vec3& b = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][(k + 1) % 3])];
      sum += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    }
  return cloth.mesh.scale * sum / count;
}

Sampling sampling_of(const ClothCopy& cloth, int detail) {
  if (cloth.mesh) return {};
  const int side = std::max(cloth.columns, cloth.rows);
  const int thin = cloth.torn || side < 3 * detail / 2 ? 1 : (side + detail - 1) / detail;
  return {std::clamp(detail / side, 1, 6), thin};
}

std::vector<float> thinned(const std::vector<float>& values, const ClothCopy& cloth, int step) {
  const int columns = (cloth.columns - 2) / step + 2, rows = (cloth.rows - 2) / step + 2;
  std::vector<float> kept;
  kept.reserve(count(columns, rows));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      kept.push_back(values[cloth.at(std::min(i * step, cloth.columns - 1),
                                     std::min(j * step, cloth.rows - 1))]);
  return kept;
}

ClothCopy thinned(const ClothCopy& cloth, int step) {
  ClothCopy thin;
  thin.columns = thin.stride = (cloth.columns - 2) / step + 2;
  thin.rows = (cloth.rows - 2) / step + 2;
  thin.topology_version = cloth.topology_version;
  thin.x = thinned(cloth.x, cloth, step);
  thin.y = thinned(cloth.y, cloth, step);
  thin.z = thinned(cloth.z, cloth, step);
  return thin;
}

void size_surface(const ClothCopy& cloth, int refinement, ClothSurface& surface) {
  surface.refinement = refinement;
  surface.columns = (cloth.columns - 1) * refinement + 1;
  surface.rows = (cloth.rows - 1) * refinement + 1;
  for (auto* on_request : {&surface.fx, &surface.fy, &surface.fz, &surface.strain})
    on_request->clear();
}

void build_surface(const ClothCopy& cloth, ClothSurface& surface) {
  refine(cloth.x, cloth, surface.refinement, surface.x);
  refine(cloth.y, cloth, surface.refinement, surface.y);
  refine(cloth.z, cloth, surface.refinement, surface.z);
  compute_normals(surface);
}

Offsets offsets_of(const Cloth& description) {
  Offsets offsets;
  if (description.level > 0) {
    for (int n = 1; n <= description.level; ++n) {
      auto& straight = n == 1 ? offsets.structural : offsets.bend;
      straight.insert(straight.end(), {{n, 0}, {0, n}});
      offsets.shear.push_back({n, n});
      if (description.level_diagonals == LevelDiagonals::both) offsets.shear.push_back({n, -n});
    }
    return offsets;
  }
  const Kinds& k = description.stiffness;
  if (k.structural > 0) offsets.structural = {{1, 0}, {0, 1}};
  if (k.shear > 0) offsets.shear = {{1, 1}, {1, -1}};
  if (k.bend > 0) offsets.bend = {{2, 0}, {0, 2}};
  return offsets;
}

// f += k (|d| - l) d / |d|
void add_forces(const ClothCopy& cloth, const Cloth& description, int step, ClothSurface& surface) {
  std::vector<float> fx(cloth.x.size()), fy = fx, fz = fx;
  if (cloth.mesh) {
    surface.fx = fx, surface.fy = fy, surface.fz = fz;
    return;
  }
  const auto add = [&](const std::vector<Offset>& offsets, double stiffness) {
    const auto k = static_cast<float>(stiffness);
    for (const Offset o : offsets) {
      const float rest = rest_length(description.grid, o);
      each_link(cloth, o, [&](std::size_t a, std::size_t b) {
        const float dx = cloth.x[b] - cloth.x[a];
        const float dy = cloth.y[b] - cloth.y[a];
        const float dz = cloth.z[b] - cloth.z[a];
        const float now = std::sqrt(dx * dx + dy * dy + dz * dz);
        const int columns = cloth.columns, i = int(a) % columns, j = int(a) / columns;
        const auto share = static_cast<float>(width_share(description, i, j, o.di, o.dj));
        const float s = now > 0 ? share * k * (now - rest) / now : 0;
        fx[a] += s * dx, fy[a] += s * dy, fz[a] += s * dz;
        fx[b] -= s * dx, fy[b] -= s * dy, fz[b] -= s * dz;
      });
    }
  };
  if (const Membrane& m = description.membrane; m.given()) {  // as the springs that stand for it
    add({{1, 0}}, m.warp - m.shear);
    add({{0, 1}}, m.weft - m.shear);
    add({{1, 1}, {1, -1}}, m.shear);
  } else {
    const Offsets offsets = offsets_of(description);
    const Kinds& k = description.stiffness;
    const bool levels = description.level > 0;
    add(offsets.structural, k.structural);
    add(offsets.shear, levels ? k.structural : k.shear);
    add(offsets.bend, levels ? k.structural : k.bend);
  }
  spread(fx, cloth, step, surface, surface.fx);
  spread(fy, cloth, step, surface, surface.fy);
  spread(fz, cloth, step, surface, surface.fz);
}

void add_strains(const ClothCopy& cloth, const Cloth& description, int step,
                 ClothSurface& surface) {
  std::vector<float> strain(cloth.x.size());
  if (cloth.mesh) return add_mesh_strains(cloth, description, surface.strain);
  for (const Offset o : {Offset{1, 0}, Offset{0, 1}}) {
    const float rest = rest_length(description.grid, o);
    each_link(cloth, o, [&](std::size_t a, std::size_t b) {
      const float dx = cloth.x[b] - cloth.x[a];
      const float dy = cloth.y[b] - cloth.y[a];
      const float dz = cloth.z[b] - cloth.z[a];
      const float e = std::abs(std::sqrt(dx * dx + dy * dy + dz * dz) / rest - 1);
      strain[a] = std::max(strain[a], e);
      strain[b] = std::max(strain[b], e);
    });
  }
  spread(strain, cloth, step, surface, surface.strain);
}

}  // namespace weft::viewer
