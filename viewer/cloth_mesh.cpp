// The cloth's surface on the graphics card. The buffer is given up and filled anew each time, so
// that the card never waits for the processor nor the other way round.
#include "meshes.h"

namespace weft::viewer {

namespace {

void append_line(std::vector<std::uint32_t>& indices, int a, int b) {
  indices.push_back(static_cast<std::uint32_t>(a));
  indices.push_back(static_cast<std::uint32_t>(b));
}

void append_lines(std::vector<std::uint32_t>& indices, const std::vector<Offset>& offsets,
                  int columns, int rows) {
  for (const Offset o : offsets)
    for (int j = std::max(0, -o.dj); j < rows - std::max(0, o.dj); ++j)
      for (int i = 0; i < columns - o.di; ++i)
        append_line(indices, j * columns + i, (j + o.dj) * columns + i + o.di);
}

}  // namespace

ClothMesh::ClothMesh()
    : array_(make_vertex_array()),
      vertices_(make_buffer()),
      coordinates_(make_buffer()),
      indices_(make_buffer()) {}

void ClothMesh::update(const ClothCopy& cloth, const Cloth& description, const Look& look,
                       int refinement) {
  if (look.draw != Look::Draw::surface) refinement = 1;
  if (refinement == 0) refinement = chosen_refinement(cloth.columns, cloth.rows);
  build_surface(cloth, refinement, surface_);
  if (look.forces) add_forces(cloth, description, surface_);
  if (look.strains) add_strains(cloth, description, surface_);
  glBindVertexArray(array_.id());
  upload_vertices();
  const bool same = columns_ == cloth.columns && rows_ == cloth.rows && refinement_ == refinement &&
                    topology_ == cloth.topology_version && level_ == description.level &&
                    kinds_ == description.stiffness;
  if (same) return;
  columns_ = cloth.columns;
  rows_ = cloth.rows;
  refinement_ = refinement;
  topology_ = cloth.topology_version;
  level_ = description.level;
  kinds_ = description.stiffness;
  upload_topology(cloth, description);
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

void ClothMesh::upload_topology(const ClothCopy& cloth, const Cloth& description) {
  const int columns = surface_.columns, rows = surface_.rows;
  std::vector<float> uv;
  uv.reserve(2 * surface_.x.size());
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      uv.push_back(static_cast<float>(i) / static_cast<float>(columns - 1));
      uv.push_back(static_cast<float>(j) / static_cast<float>(rows - 1));
    }
  glBindBuffer(GL_ARRAY_BUFFER, coordinates_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(uv.size() * sizeof(float)), uv.data(),
               GL_STATIC_DRAW);
  glEnableVertexAttribArray(kTexture);
  glVertexAttribPointer(kTexture, 2, GL_FLOAT, GL_FALSE, 0, nullptr);

  std::vector<std::uint32_t> indices;
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) {
      const auto a = static_cast<std::uint32_t>(j * columns + i);
      const auto below = a + static_cast<std::uint32_t>(columns);
      indices.insert(indices.end(), {a, a + 1, below, a + 1, below + 1, below});
    }
  triangles_ = {static_cast<GLsizei>(indices.size()), 0};
  if (refinement_ == 1) {
    const Offsets offsets = offsets_of(description);
    const std::vector<Offset>* const kinds[] = {&offsets.structural, &offsets.shear, &offsets.bend};
    for (int kind = 0; kind < 3; ++kind) {
      const std::size_t start = indices.size();
      append_lines(indices, *kinds[kind], cloth.columns, cloth.rows);
      lines_[kind] = {static_cast<GLsizei>(indices.size() - start), start};
    }
  }
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
               GL_STATIC_DRAW);
}

void ClothMesh::draw_surface() const {
  glBindVertexArray(array_.id());
  glDrawElements(GL_TRIANGLES, triangles_.count, GL_UNSIGNED_INT, nullptr);
}

void ClothMesh::draw_lines(Kind kind) const {
  glBindVertexArray(array_.id());
  glDrawElements(GL_LINES, lines_[kind].count, GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(lines_[kind].offset * sizeof(std::uint32_t)));
}

void ClothMesh::draw_points() const {
  glBindVertexArray(array_.id());
  glDrawArrays(GL_POINTS, 0, vertices());
}

}  // namespace weft::viewer
