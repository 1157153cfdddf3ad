// Triangles over seams (over_seams.h).
#include "physics/contact/self/over_seams.h"

#include <algorithm>

namespace weft::physics {
namespace {

// Thicknesses, by edges over the seam: a surface keeps off by half of what lies between at rest, and edges are
// up to a third longer than the straight way.
constexpr double kBeside = 2.6;

}  // namespace

OverSeams::OverSeams(const std::vector<Sheet>& sheets, const std::vector<NamedSheet>& named,
                     std::size_t bodies) {
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    const Sheet& sheet = sheets[s];
    if (!sheet.mesh || !sheet.mesh->sewn()) continue;
    near_.resize(bodies);
    const auto body = [&](std::size_t vertex) {
      const auto [row, column] = sheet.points->place(int(vertex));
      return named[s].name(row, column);
    };
    const auto near = sheet.mesh->sewn_neighbours(kBeside * double(sheet.thickness));
    for (std::size_t v = 0; v < near.size(); ++v) {
      std::vector<std::int32_t>& of = near_[std::size_t(body(v))];
      for (const int vertex : near[v]) of.push_back(body(std::size_t(vertex)));
      std::sort(of.begin(), of.end());
    }
  }
}

bool OverSeams::join(const Square& one, const Square& other) const {
  if (near_.empty()) return false;
  return std::any_of(one.corner, one.corner + 4, [&](std::int32_t a) {
    const std::vector<std::int32_t>& of = near_[std::size_t(a)];
    return !of.empty() && std::any_of(other.corner, other.corner + 4, [&](std::int32_t b) {
      return std::binary_search(of.begin(), of.end(), b);
    });
  });
}

std::size_t OverSeams::bytes() const {
  std::size_t bytes = 0;
  for (const auto& of : near_) bytes += sizeof of + sizeof(std::int32_t) * of.capacity();
  return bytes;
}

}  // namespace weft::physics
