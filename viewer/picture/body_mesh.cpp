// Bodies and the floor as triangles.
#include <cstddef>
#include <numbers>

#include "picture/meshes.h"

namespace weft::viewer {

namespace {

using Vertices = std::vector<BodyMesh::Vertex>;
using Indices = std::vector<std::uint32_t>;

// Triangles of a lattice of (columns + 1) * (rows + 1) vertices, the last ones added.
void append_lattice(Indices& indices, std::size_t first, int columns, int rows) {
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto a =
          static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(j * (columns + 1) + i);
      const auto b = a + static_cast<std::uint32_t>(columns) + 1;
      indices.insert(indices.end(), {a, a + 1, b, a + 1, b + 1, b});
    }
}

// A surface of revolution about the axis: at step j of `rows` the centre and the direction of the
// normal in the plane of axis and radius.
BodyMesh revolve(Vec3f a, Vec3f b, float radius, int around) {
  Vertices vertices;
  Indices indices;
  const Vec3f axis = length(b - a) > 0 ? normalized(b - a) : Vec3f{0, 1, 0};
  const Vec3f e = any_normal(axis), f = cross(axis, e);
  const bool ball = a == b;
  const int half = around / 4, rows = ball ? 2 * half : 2 * half + 1;
  for (int j = 0; j <= rows; ++j) {
    const int step = ball || j <= half ? j : j - 1;
    const Vec3f center = ball || j <= half ? a : b;
    const float polar =
        std::numbers::pi_v<float> * static_cast<float>(step) / static_cast<float>(2 * half);
    for (int i = 0; i <= around; ++i) {
      const float turn =
          2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(around);
      const Vec3f n =
          (e * std::cos(turn) + f * std::sin(turn)) * std::sin(polar) - axis * std::cos(polar);
      vertices.push_back({center + n * radius, n,
                          2 * static_cast<float>(i) / static_cast<float>(around),
                          static_cast<float>(j) / static_cast<float>(rows)});
    }
  }
  append_lattice(indices, 0, around, rows);
  return {vertices, indices};
}

// A shape's own triangles; the texture runs around and along it by the order of its vertices' angles.
BodyMesh plain_mesh(const ShapeMesh& mesh) {
  Vertices vertices;
  Indices indices;
  for (std::size_t n = 0; n < mesh.positions.size(); ++n) {
    const Vec3f p = to_float(mesh.positions[n]);
    vertices.push_back({p, to_float(mesh.normals[n]), p.x + p.z, p.y});
  }
  for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  return {vertices, indices};
}

struct Axes {
  Vec3f x, y, z;
  Vec3f turn(Vec3f p) const { return x * p.x + y * p.y + z * p.z; }
};

// Turned about x, then y, then z [degrees].
Axes turned(const Vec3& degrees) {
  const auto rotate = [&](Vec3f p) {
    const auto angle = [&](std::size_t k) {
      return static_cast<float>(degrees[k] * std::numbers::pi / 180);
    };
    const float cx = std::cos(angle(0)), sx = std::sin(angle(0));
    p = {p.x, cx * p.y - sx * p.z, sx * p.y + cx * p.z};
    const float cy = std::cos(angle(1)), sy = std::sin(angle(1));
    p = {cy * p.x + sy * p.z, p.y, -sy * p.x + cy * p.z};
    const float cz = std::cos(angle(2)), sz = std::sin(angle(2));
    return Vec3f{cz * p.x - sz * p.y, sz * p.x + cz * p.y, p.z};
  };
  return {rotate({1, 0, 0}), rotate({0, 1, 0}), rotate({0, 0, 1})};
}

// Each face is a lattice; a point on it is the inner box's nearest point plus the rounding along
// the direction from there.
BodyMesh box_mesh(const Box& box, int tessellation) {
  Vertices vertices;
  Indices indices;
  const Axes axes = turned(box.rotation);
  const Vec3f half = to_float(box.half), center = to_float(box.center);
  const auto r = static_cast<float>(box.rounding);
  const Vec3f inner = half - Vec3f{r, r, r};
  const int n = r > 0 ? tessellation / 4 : 1;
  for (int face = 0; face < 6; ++face) {
    const std::size_t first = vertices.size();
    const float side = face < 3 ? 1.0f : -1.0f;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const float s = 2 * static_cast<float>(i) / static_cast<float>(n) - 1;
        const float t = 2 * static_cast<float>(j) / static_cast<float>(n) - 1;
        const Vec3f along = face % 3 == 0   ? Vec3f{side, s, t}
                            : face % 3 == 1 ? Vec3f{s, side, t}
                                            : Vec3f{s, t, side};
        const Vec3f p{along.x * half.x, along.y * half.y, along.z * half.z};
        const Vec3f core{std::clamp(p.x, -inner.x, inner.x), std::clamp(p.y, -inner.y, inner.y),
                         std::clamp(p.z, -inner.z, inner.z)};
        const Vec3f flat = face % 3 == 0   ? Vec3f{side, 0, 0}
                           : face % 3 == 1 ? Vec3f{0, side, 0}
                                           : Vec3f{0, 0, side};
        const Vec3f normal = r > 0 ? normalized(p - core) : flat;
        vertices.push_back(
            {center + axes.turn(core + normal * r), axes.turn(normal), (s + 1) / 2, (t + 1) / 2});
      }
    append_lattice(indices, first, n, n);
  }
  return {vertices, indices};
}

BodyMesh square(Vec3f center, Vec3f normal, float half) {
  const Vec3f e = any_normal(normal), f = cross(normal, e);
  Vertices vertices;
  for (int j = -1; j <= 1; j += 2)
    for (int i = -1; i <= 1; i += 2) {
      const Vec3f p =
          center + e * (half * static_cast<float>(i)) + f * (half * static_cast<float>(j));
      vertices.push_back({p, normal, dot(p, e), dot(p, f)});
    }
  return {vertices, {0, 1, 2, 1, 3, 2}};
}

}  // namespace

BodyMesh::BodyMesh(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices)
    : array_(make_vertex_array()),
      vertices_(make_buffer()),
      indices_(make_buffer()),
      count_(static_cast<GLsizei>(indices.size())) {
  glBindVertexArray(array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
               vertices.data(), GL_STATIC_DRAW);
  for (GLuint k = 0; k < 6; ++k) {  // positions and normals, one component each
    glEnableVertexAttribArray(k);
    glVertexAttribPointer(k, 1, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          reinterpret_cast<const void*>(k * sizeof(float)));
  }
  glEnableVertexAttribArray(kTexture);
  glVertexAttribPointer(kTexture, 2, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                        reinterpret_cast<const void*>(offsetof(Vertex, u)));
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
               GL_STATIC_DRAW);
}

void BodyMesh::draw() const {
  glBindVertexArray(array_.id());
  glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
}

BodyMesh make_body(const Shape& shape, float size, int tessellation) {
  if (const Sphere* s = std::get_if<Sphere>(&shape)) {
    const Vec3f c = to_float(s->center);
    return revolve(c, c, static_cast<float>(s->radius), tessellation);
  }
  if (const Capsule* c = std::get_if<Capsule>(&shape))
    return revolve(to_float(c->a), to_float(c->b), static_cast<float>(c->radius), tessellation);
  if (const Box* b = std::get_if<Box>(&shape)) return box_mesh(*b, tessellation);
  if (const Plane* plane = std::get_if<Plane>(&shape))
    return square(to_float(plane->point), normalized(to_float(plane->normal)), size);
  return plain_mesh(triangulate(shape));
}

BodyMesh make_floor(Vec3f center, float half) {
  return square(center, {0, 1, 0}, half);
}

}  // namespace weft::viewer
