// The cloth's surface on the graphics card. The buffer is given up and filled anew each time, so
// that the card never waits for the processor nor the other way round.
#include "picture/meshes.h"
#include "weft/mesh.h"

namespace weft::viewer {

namespace {

void append_line(std::vector<std::uint32_t>& indices, int a, int b) {
  indices.push_back(static_cast<std::uint32_t>(a));
  indices.push_back(static_cast<std::uint32_t>(b));
}

void upload(const std::vector<std::uint32_t>& indices, const Buffer& to) {
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, to.id());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
               GL_DYNAMIC_DRAW);
}

// Whether the square to the lower right of particle (i,j) is drawn; six indices each.
bool has_square(const std::vector<std::uint32_t>& triangles, int columns, int i, int j) {
  const auto at = 6 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(columns - 1) +
                       static_cast<std::size_t>(i));
  return triangles[at] != triangles[at + 1];
}

// Of a torn cloth, those that run along a square which is left.
void append_lines(std::vector<std::uint32_t>& indices, const std::vector<Offset>& offsets,
                  const ClothCopy& cloth, const std::vector<std::uint32_t>& triangles) {
  const int columns = cloth.columns, rows = cloth.rows;
  const auto near_square = [&](int i, int j) {
    bool found = false;
    for (int b = std::max(0, j - 1); b <= std::min(j, rows - 2); ++b)
      for (int a = std::max(0, i - 1); a <= std::min(i, columns - 2); ++a)
        found = found || has_square(triangles, columns, a, b);
    return found;
  };
  for (const Offset o : offsets)
    for (int j = std::max(0, -o.dj); j < rows - std::max(0, o.dj); ++j)
      for (int i = 0; i < columns - o.di; ++i) {
        bool left = true;
        const int steps = std::max(std::abs(o.di), std::abs(o.dj));
        for (int s = 0; s < steps && cloth.torn && left; ++s) {
          const int a = i + s * o.di / steps, b = j + s * o.dj / steps;
          const int square = std::min(b, b + o.dj / steps);
          left = o.di != 0 && o.dj != 0
                     ? has_square(triangles, columns, a, square)
                     : near_square(a, b) && near_square(a + o.di / steps, b + o.dj / steps);
        }
        if (left) append_line(indices, j * columns + i, (j + o.dj) * columns + i + o.di);
      }
}

// Texture coordinates of a mesh, one for each vertex: those of the file, or from 0 to 1 along the two sides
// in which it is largest.
std::vector<float> mesh_coordinates(const MeshSource& source) {
  const TriangleMesh& mesh = *source.shape;
  std::vector<float> uv(2 * mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.uv.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t side = 0; side < 2; ++side)
        uv[2 * static_cast<std::size_t>(mesh.triangles[t][k]) + side] =
            static_cast<float>(mesh.uv[t][k][side]);
  if (!mesh.uv.empty()) return uv;
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& v : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = std::min(low[k], v[k]), high[k] = std::max(high[k], v[k]);
  std::size_t thin = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (high[k] - low[k] < high[thin] - low[thin]) thin = k;
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n)
    for (std::size_t k = 0, side = 0; k < 3; ++k)
      if (k != thin)
        uv[2 * n + side++] =
            static_cast<float>((mesh.vertices[n][k] - low[k]) / std::max(high[k] - low[k], 1e-9));
  return uv;
}

// Of a grid's vertices.
std::vector<float> grid_coordinates(const ClothSurface& surface) {
  const int columns = surface.columns, rows = surface.rows;
  std::vector<float> uv;
  uv.reserve(2 * surface.x.size());
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      uv.push_back(static_cast<float>(i) / static_cast<float>(columns - 1));
      uv.push_back(static_cast<float>(j) / static_cast<float>(rows - 1));
    }
  return uv;
}

}  // namespace

ClothMesh::ClothMesh()
    : array_(make_vertex_array()),
      vertices_(make_buffer()),
      coordinates_(make_buffer()),
      indices_(make_buffer()),
      tear_indices_(make_buffer()),
      rim_indices_(make_buffer()),
      line_indices_(make_buffer()) {}

void ClothMesh::update(const ClothCopy& whole, std::uint64_t scene, const Cloth& description,
                       const Look& look, Sampling sampling, float thickness) {
  if (look.draw != Look::Draw::surface || whole.mesh)
    sampling = {1, whole.mesh ? 1 : sampling.step};
  const ClothCopy thin = sampling.step > 1 ? thinned(whole, sampling.step) : ClothCopy{};
  const ClothCopy& cloth = sampling.step > 1 ? thin : whole;
  const bool same_size = columns_ == whole.columns && rows_ == whole.rows && sampling_ == sampling;
  const bool rim = thickness > 0;
  const bool same =
      same_size && topology_ == whole.topology_version && scene_ == scene && rim_ == rim;
  size_surface(cloth, sampling.refinement, surface_);
  if (!same) triangulate(cloth, surface_);
  if (cloth.mesh)
    build_mesh_surface(cloth, surface_);
  else if (cloth.torn)
    build_torn_surface(cloth, surface_);
  else
    build_surface(cloth, surface_);
  if (look.forces) add_forces(whole, description, sampling.step, surface_);
  if (look.strains) add_strains(whole, description, sampling.step, surface_);
  add_tear_boundary(cloth, surface_);
  if (!same) surface_.border.clear();
  if (!same && rim) find_border(surface_);
  add_rim(thickness, surface_);
  glBindVertexArray(array_.id());
  upload_vertices();
  if (same) return;
  upload_coordinates(whole.mesh ? mesh_coordinates(description.mesh) : grid_coordinates(surface_),
                     cloth);
  upload_triangles();
  if (sampling.refinement == 1) upload_lines(cloth, description);
  columns_ = whole.columns;
  rows_ = whole.rows;
  sampling_ = sampling;
  topology_ = whole.topology_version;
  scene_ = scene;
  rim_ = rim;
}

void ClothMesh::upload_vertices() {
  const std::vector<float>* const arrays[] = {
      &surface_.x,  &surface_.y,  &surface_.z,  &surface_.nx, &surface_.ny,
      &surface_.nz, &surface_.fx, &surface_.fy, &surface_.fz, &surface_.strain};
  static constexpr GLuint attributes[] = {0, 1, 2, 3, 4, 5, 7, 8, 9, 10};
  const std::size_t bytes = surface_.x.size() * sizeof(float);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(10 * bytes), nullptr, GL_STREAM_DRAW);
  for (std::size_t a = 0; a < std::size(arrays); ++a) {
    if (arrays[a]->empty()) {
      glDisableVertexAttribArray(attributes[a]);
      continue;
    }
    glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(a * bytes),
                    static_cast<GLsizeiptr>(bytes), arrays[a]->data());
    glEnableVertexAttribArray(attributes[a]);
    glVertexAttribPointer(attributes[a], 1, GL_FLOAT, GL_FALSE, 0,
                          reinterpret_cast<const void*>(a * bytes));
  }
}

void ClothMesh::upload_coordinates(std::vector<float> uv, const ClothCopy& cloth) {
  for (const std::uint32_t particle : cloth.tear_particles) {
    const std::size_t v = vertex_of(cloth, surface_, particle);
    uv.insert(uv.end(), {uv[2 * v], uv[2 * v + 1]});
  }
  for (const std::size_t v : surface_.rim_of) uv.insert(uv.end(), {uv[2 * v], uv[2 * v + 1]});
  glBindBuffer(GL_ARRAY_BUFFER, coordinates_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(uv.size() * sizeof(float)), uv.data(),
               GL_STATIC_DRAW);
  glEnableVertexAttribArray(kTexture);
  glVertexAttribPointer(kTexture, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
}

// The card has the same triangles but for those between the first and the last that changed.
void ClothMesh::upload_triangles() {
  const std::vector<std::uint32_t>& now = surface_.indices;
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
  if (now.size() != uploaded_.size()) {
    upload(now, indices_);
  } else {
    const auto first = std::mismatch(now.begin(), now.end(), uploaded_.begin()).first - now.begin();
    const auto after =
        now.rend() - std::mismatch(now.rbegin(), now.rend(), uploaded_.rbegin()).first;
    if (first < after)
      glBufferSubData(GL_ELEMENT_ARRAY_BUFFER,
                      static_cast<GLintptr>(first) * static_cast<GLintptr>(sizeof(std::uint32_t)),
                      (after - first) * static_cast<GLsizeiptr>(sizeof(std::uint32_t)),
                      now.data() + first);
  }
  uploaded_ = now;
  upload(surface_.tear_indices, tear_indices_);
  upload(surface_.rim_indices, rim_indices_);
}

void ClothMesh::upload_lines(const ClothCopy& cloth, const Cloth& description) {
  std::vector<std::uint32_t> indices;
  const Offsets offsets = cloth.mesh ? Offsets{} : offsets_of(description);
  const std::vector<Offset>* const kinds[] = {&offsets.structural, &offsets.shear, &offsets.bend};
  for (int kind = 0; kind < 3; ++kind) {
    const std::size_t start = indices.size();
    append_lines(indices, *kinds[kind], cloth, surface_.indices);
    if (cloth.mesh && kind == structural)
      for (const auto& edge : edges_of(cloth))
        indices.insert(indices.end(), edge.begin(), edge.end());
    lines_[kind] = {static_cast<GLsizei>(indices.size() - start), start};
  }
  upload(indices, line_indices_);
}

void ClothMesh::draw_triangles(const Buffer& indices, std::size_t count) const {
  if (count == 0) return;
  glBindVertexArray(array_.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.id());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count), GL_UNSIGNED_INT, nullptr);
}

void ClothMesh::draw_surface() const {
  draw_triangles(indices_, uploaded_.size());
  draw_triangles(tear_indices_, surface_.tear_indices.size());
}

void ClothMesh::draw_rim() const {
  draw_triangles(rim_indices_, surface_.rim_indices.size());
}

void ClothMesh::draw_lines(Kind kind) const {
  glBindVertexArray(array_.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, line_indices_.id());
  glDrawElements(GL_LINES, lines_[kind].count, GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(lines_[kind].offset * sizeof(std::uint32_t)));
}

void ClothMesh::draw_points() const {
  glBindVertexArray(array_.id());
  glDrawArrays(GL_POINTS, 0, vertices());
}

}  // namespace weft::viewer
