// The band between the two faces of a thick cloth, along its border.
#include <algorithm>

#include "picture/surface.h"
#include "weft/mesh.h"

namespace weft::viewer {

namespace {

// Pairs by their lower vertex, which has a few: counted, and put into their places.
class Sides {
 public:
  Sides(const std::vector<std::uint32_t>& corners, std::size_t vertices) : first_(vertices + 1) {
    each(corners, [&](std::uint32_t a, std::uint32_t b) { ++first_[std::min(a, b) + 1]; });
    for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
    sides_.resize(first_[vertices]);
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    each(corners, [&](std::uint32_t a, std::uint32_t b) {
      sides_[next[std::min(a, b)]++] = {a, b};
    });
  }

  // Those that are there once, from corner to corner as their triangle turns.
  std::vector<std::array<std::uint32_t, 2>> single() const {
    std::vector<std::array<std::uint32_t, 2>> found;
    for (std::size_t v = 0; v + 1 < first_.size(); ++v)
      for (std::size_t k = first_[v]; k < first_[v + 1]; ++k) {
        const auto same = [&](const std::array<std::uint32_t, 2>& side) {
          return side[0] + side[1] == sides_[k][0] + sides_[k][1];
        };
        if (std::count_if(sides_.begin() + offset(first_[v]),
                          sides_.begin() + offset(first_[v + 1]), same) == 1)
          found.push_back(sides_[k]);
      }
    return found;
  }

 private:
  static std::ptrdiff_t offset(std::size_t n) { return static_cast<std::ptrdiff_t>(n); }

  template <class Call>
  static void each(const std::vector<std::uint32_t>& corners, Call call) {
    for (std::size_t t = 0; t < corners.size(); t += 3) {
      if (corners[t] == corners[t + 1]) continue;  // drawn as a point
      for (std::size_t k = 0; k < 3; ++k) call(corners[t + k], corners[t + (k + 1) % 3]);
    }
  }

  std::vector<std::size_t> first_;  // of a vertex's sides
  std::vector<std::array<std::uint32_t, 2>> sides_;
};

}  // namespace

float thickness_of(const Cloth& cloth) {
  const SelfCollision& self = cloth.self_collision;
  if (self.mode != SelfCollisionMode::off) return static_cast<float>(self.thickness);
  // Woven and knitted fabrics have .3 to .6 g/cm³, and none is thicker than felt, whatever a scene's sheet weighs.
  constexpr double kBulkDensity = 450, kFelt = 0.005;  // kg/m³, m
  return static_cast<float>(std::min(area_density(cloth) / kBulkDensity, kFelt));
}

void find_border(ClothSurface& surface) {
  const std::size_t lattice = surface.x.size();
  surface.border = Sides(surface.indices, lattice).single();
  const auto torn = Sides(surface.tear_indices, lattice).single();
  surface.border.insert(surface.border.end(), torn.begin(), torn.end());
}

void add_rim(float width, ClothSurface& s) {
  s.rim_indices.clear();
  s.rim_of.clear();
  const auto at = [&](std::uint32_t v) { return Vec3f{s.x[v], s.y[v], s.z[v]}; };
  const auto half = [&](std::uint32_t v) {
    return normalized({s.nx[v], s.ny[v], s.nz[v]}) * (width / 2);
  };
  for (const auto& side : s.border) {
    const Vec3f out = cross(at(side[1]) - at(side[0]), half(side[0]) + half(side[1]));
    const auto first = static_cast<std::uint32_t>(s.x.size());
    for (const std::uint32_t v : side)
      for (const float face : {1.0f, -1.0f}) {
        const Vec3f p = at(v) + half(v) * face;
        s.x.push_back(p.x), s.y.push_back(p.y), s.z.push_back(p.z);
        s.nx.push_back(out.x), s.ny.push_back(out.y), s.nz.push_back(out.z);
        for (auto* values : {&s.fx, &s.fy, &s.fz, &s.strain})
          if (!values->empty()) values->push_back((*values)[v]);
        s.rim_of.push_back(v);
      }
    for (const std::uint32_t k : {0, 1, 3, 0, 3, 2}) s.rim_indices.push_back(first + k);
  }
}

}  // namespace weft::viewer
