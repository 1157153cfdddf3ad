// Points that fill the unit cube: the draws of a study. The same numbers on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace weft {

enum class Draw { random, latin_hypercube, sobol };

inline constexpr std::size_t kSobolDimensions = 16;

// `count` points of so many dimensions, each coordinate in [0, 1); point k is at [k * dimensions].
// latin_hypercube: every one of `count` equal layers of each dimension holds one point (McKay, Beckman,
// Conover 1979). sobol: Sobol's sequence with the direction numbers of Joe and Kuo (2008), shifted digit
// by digit by the seed: of any 2^m points that follow a multiple of 2^m, each of 2^m layers holds one.
std::vector<double> draw_points(Draw draw, std::size_t count, std::size_t dimensions,
                                std::uint64_t seed);

}  // namespace weft
