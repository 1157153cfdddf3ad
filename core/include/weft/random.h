// The one source of random numbers: SplitMix64 (Steele, Lea, Flood 2014), the same on every machine.
#pragma once

#include <cstdint>

namespace weft {

class Random {
 public:
  // Streams of different `stream` numbers are independent.
  Random(std::uint64_t seed, std::uint64_t stream)
      : state_(seed * 0x9e3779b97f4a7c15u ^ (stream + 1) * 0xd1342543de82ef95u) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  // Uniform in [0, 1).
  double unit() { return double(bits() >> 11) * 0x1p-53; }
  // Uniform in [-1, 1).
  double symmetric() { return 2 * unit() - 1; }

 private:
  std::uint64_t state_;
};

}  // namespace weft
