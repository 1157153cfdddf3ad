#include "scene/mesh/unjoined.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "scene/mesh/welding.h"
#include "weft/mesh.h"

namespace weft::text {

void note_unjoined(const Cloth& cloth, const std::string& place, std::vector<std::string>& notes) {
  const TriangleMesh& mesh = *cloth.mesh.shape;
  std::vector<int> first_in_seam(mesh.vertices.size());
  std::iota(first_in_seam.begin(), first_in_seam.end(), 0);
  for (const std::vector<int>& group : sewn_vertices(cloth))
    for (const int vertex : group) first_in_seam[std::size_t(vertex)] = group.front();

  std::vector<int> corners;  // each once
  for (const auto& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<Vec3> places;
  places.reserve(corners.size());
  for (const int vertex : corners) places.push_back(mesh.vertices[std::size_t(vertex)]);

  // Of each place, what seams make one of its vertices.
  const std::vector<int> firsts = firsts_in_place(places);
  std::vector<std::array<int, 3>> copies;  // first in the place, first in the seam, vertex
  for (std::size_t n = 0; n < corners.size(); ++n)
    copies.push_back(
        {corners[std::size_t(firsts[n])], first_in_seam[std::size_t(corners[n])], corners[n]});
  std::sort(copies.begin(), copies.end());
  int count = 0;
  std::array<int, 2> pair{};  // with the least vertex
  for (std::size_t n = 1; n < copies.size(); ++n) {
    const auto [first, seam, vertex] = copies[n];
    if (first != copies[n - 1][0] || seam == copies[n - 1][1]) continue;
    if (count++ == 0 || vertex < pair[1]) pair = {first, vertex};
  }
  if (count == 0) return;
  const std::string a = std::to_string(pair[0]), b = std::to_string(pair[1]);
  notes.push_back(
      place + "/mesh: " + std::to_string(count) + (count == 1 ? " vertex lies" : " vertices lie") +
      " exactly on others without being joined to them, first " + b + " on " + a +
      " (counted from 0): the cloth is in pieces there. If it is to be one, merge them in the "
      "file, or join them by pairs: \"seams\": [[" +
      a + ", " + b + "], …]");
}

}  // namespace weft::text
