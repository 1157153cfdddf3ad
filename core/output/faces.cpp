#include "output/faces.h"

#include <map>

#include "output/animation.h"

namespace weft {

namespace {

// Corners in the order that makes u × v the face normal.
void add_quads(const ClothView& cloth, Faces& faces) {
  faces.corners = 4;
  const std::int64_t columns = cloth.columns;
  for (int j = 0; j + 1 < cloth.rows; ++j)
    for (int i = 0; i + 1 < cloth.columns; ++i) {
      const std::int64_t a = j * columns + i;
      faces.particles.insert(faces.particles.end(), {a, a + 1, a + columns + 1, a + columns});
    }
}

void add_triangles(const ClothView& cloth, Faces& faces) {
  std::vector<std::int64_t> numbers;  // of a mesh, by lane
  if (!cloth.lanes.empty()) numbers.resize(cloth.x.size());
  for (std::size_t n = 0; n < cloth.lanes.size(); ++n)
    numbers[cloth.lanes[n]] = static_cast<std::int64_t>(n);
  const auto stride = static_cast<std::uint32_t>(cloth.stride);
  for (const auto& t : cloth.triangles)
    for (const std::uint32_t p : t)
      faces.particles.push_back(
          numbers.empty() ? static_cast<std::int64_t>(p / stride) * cloth.columns + p % stride
                          : numbers[p]);
}

// A grid's go from 0 to 1 along its sides.
void add_grid_uv(const ClothView& cloth, Faces& faces) {
  for (int j = 0; j < cloth.rows; ++j)
    for (int i = 0; i < cloth.columns; ++i)
      faces.uv.push_back({i / double(cloth.columns - 1), j / double(cloth.rows - 1)});
  faces.uv_of = faces.particles;
}

void add_mesh_uv(const ClothView& cloth, Faces& faces) {
  if (cloth.uv.size() != cloth.triangles.size()) return;
  std::map<std::array<double, 2>, std::int64_t> numbers;
  for (const auto& corners : cloth.uv)
    for (const auto& at : corners) {
      const auto [known, fresh] =
          numbers.try_emplace(at, static_cast<std::int64_t>(faces.uv.size()));
      if (fresh) faces.uv.push_back(at);
      faces.uv_of.push_back(known->second);
    }
}

}  // namespace

Faces faces_of(const ClothView& cloth) {
  Faces faces;
  if (cloth.topology_version > 0)
    add_triangles(cloth, faces);
  else
    add_quads(cloth, faces);
  if (cloth.lanes.empty())
    add_grid_uv(cloth, faces);
  else
    add_mesh_uv(cloth, faces);
  return faces;
}

}  // namespace weft
