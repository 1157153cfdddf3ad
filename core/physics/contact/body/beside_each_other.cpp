#include "physics/contact/body/beside_each_other.h"

#include <numeric>
#include <span>

#include "physics/contact/body/box_tree.h"

namespace weft::physics {
namespace {

constexpr std::size_t kMost = 16;

// Halves them along their longest side.
void split(const Particles& particles, int j, std::span<int> lanes, double wide,
           std::vector<std::vector<int>>& groups) {
  AlignedBox box;
  for (const int i : lanes) box.add(particles.position(j, i));
  const Vec3 size = minus(box.high, box.low);
  const auto axis = std::size_t(std::max_element(size.begin(), size.end()) - size.begin());
  if (lanes.size() <= 1 || (lanes.size() <= kMost && size[axis] <= wide)) {
    groups.emplace_back(lanes.begin(), lanes.end());
    return;
  }
  const auto key = [&](int i) { return std::pair(particles.x.at(int(axis), j, i), i); };
  const std::size_t half = lanes.size() / 2;
  std::nth_element(lanes.begin(), lanes.begin() + std::ptrdiff_t(half), lanes.end(),
                   [&](int a, int b) { return key(a) < key(b); });
  split(particles, j, lanes.first(half), wide, groups);
  split(particles, j, lanes.subspan(half), wide, groups);
}

}  // namespace

std::vector<std::vector<int>> beside_each_other(const Particles& particles, int j, double wide) {
  std::vector<int> lanes(std::size_t(particles.count(j)));
  std::iota(lanes.begin(), lanes.end(), 0);
  std::vector<std::vector<int>> groups;
  split(particles, j, lanes, wide, groups);
  return groups;
}

}  // namespace weft::physics
