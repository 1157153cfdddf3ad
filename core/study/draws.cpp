#include "study/draws.h"

#include <array>
#include <bit>
#include <cassert>
#include <utility>

#include "weft/random.h"

namespace weft {

namespace {

constexpr int kBits = 32;
using Directions = std::array<std::uint32_t, kBits>;

// A primitive polynomial over two elements, its inner coefficients as bits, and the first direction
// numbers (odd, below 2, 4, 8 …).
struct Polynomial {
  int degree;
  std::uint32_t coefficients;
  std::array<std::uint32_t, 6> first;
};
constexpr std::array<Polynomial, kSobolDimensions - 1> kPolynomials{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
}};

Directions directions_of(std::size_t dimension) {
  Directions v{};
  if (dimension == 0) {  // van der Corput's sequence
    for (int k = 0; k < kBits; ++k) v[std::size_t(k)] = 1u << (kBits - 1 - k);
    return v;
  }
  const Polynomial& p = kPolynomials[dimension - 1];
  const auto s = std::size_t(p.degree);
  for (std::size_t k = 0; k < s; ++k) v[k] = p.first[k] << (kBits - 1 - k);
  for (std::size_t k = s; k < kBits; ++k) {
    v[k] = v[k - s] ^ (v[k - s] >> s);
    for (std::size_t q = 1; q < s; ++q)
      if ((p.coefficients >> (s - 1 - q) & 1) != 0) v[k] ^= v[k - q];
  }
  return v;
}

void sobol(std::size_t dimension, std::size_t dimensions, Random& random,
           std::vector<double>& points) {
  const Directions v = directions_of(dimension);
  auto x = std::uint32_t(random.bits() >> 32);  // the shift; then Gray code, one digit a point
  for (std::size_t k = 0, n = points.size() / dimensions; k < n; ++k) {
    points[k * dimensions + dimension] = double(x) * 0x1p-32;
    x ^= v[std::size_t(std::countr_one(k)) % kBits];
  }
}

void latin_hypercube(std::size_t dimension, std::size_t dimensions, Random& random,
                     std::vector<double>& points) {
  const std::size_t n = points.size() / dimensions;
  const auto at = [&](std::size_t k) -> double& { return points[k * dimensions + dimension]; };
  for (std::size_t k = 0; k < n; ++k) at(k) = (double(k) + random.unit()) / double(n);
  for (std::size_t k = n; k > 1; --k) std::swap(at(k - 1), at(random.bits() % k));
}

}  // namespace

std::vector<double> draw_points(Draw draw, std::size_t count, std::size_t dimensions,
                                std::uint64_t seed) {
  assert(draw != Draw::sobol || dimensions <= kSobolDimensions);
  std::vector<double> points(count * dimensions);
  for (std::size_t d = 0; d < dimensions; ++d) {
    Random random(seed, d);
    if (draw == Draw::sobol) sobol(d, dimensions, random, points);
    if (draw == Draw::latin_hypercube) latin_hypercube(d, dimensions, random, points);
    if (draw == Draw::random)
      for (std::size_t k = 0; k < count; ++k) points[k * dimensions + d] = random.unit();
  }
  return points;
}

}  // namespace weft
