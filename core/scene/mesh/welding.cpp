#include "scene/mesh/welding.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace weft::text {

std::vector<int> firsts_in_place(const std::vector<Vec3>& vertices) {
  std::vector<int> order(vertices.size()), firsts(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](int n) -> const Vec3& { return vertices[std::size_t(n)]; };
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return at(a) < at(b) || (!(at(b) < at(a)) && a < b); });
  for (std::size_t n = 0; n < order.size(); ++n) {
    const bool copy = n > 0 && at(order[n]) == at(order[n - 1]);
    firsts[std::size_t(order[n])] = copy ? firsts[std::size_t(order[n - 1])] : order[n];
  }
  return firsts;
}

void part(std::vector<int>& firsts, const std::function<bool(int first, int vertex)>& apart) {
  constexpr std::size_t kMostParts = 8;
  std::map<int, std::vector<int>> parted;  // from a first
  for (std::size_t n = 0; n < firsts.size(); ++n) {
    const int vertex = int(n);
    int& first = firsts[n];
    if (first == vertex || !apart(first, vertex)) continue;
    std::vector<int>& others = parted[first];
    const auto alike = std::find_if(others.begin(), others.end(),
                                    [&](int other) { return !apart(other, vertex); });
    if (alike != others.end()) {
      first = *alike;
      continue;
    }
    first = vertex;
    if (others.size() < kMostParts) others.push_back(vertex);
  }
}

std::vector<int> numbers_of(const std::vector<int>& firsts) {
  std::vector<int> numbers(firsts.size());
  int left = 0;
  for (std::size_t n = 0; n < firsts.size(); ++n)
    numbers[n] = firsts[n] == int(n) ? left++ : numbers[std::size_t(firsts[n])];
  return numbers;
}

std::vector<int> weld(std::vector<Vec3>& vertices) {
  const std::vector<int> firsts = firsts_in_place(vertices);
  std::size_t left = 0;
  for (std::size_t n = 0; n < firsts.size(); ++n)
    if (firsts[n] == int(n)) vertices[left++] = vertices[n];
  vertices.resize(left);
  return numbers_of(firsts);
}

}  // namespace weft::text
