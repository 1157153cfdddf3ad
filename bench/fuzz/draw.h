// Random draws by which scenes and inputs are made. One seed gives the same draws everywhere.
#pragma once

#include <cmath>
#include <initializer_list>

#include "weft/random.h"
#include "weft/scene.h"

namespace fuzz {

using weft::Vec3;

class Draw {
 public:
  // Streams of different numbers are independent.
  Draw(std::uint64_t seed, std::uint64_t stream) : random_(seed, stream) {}

  std::uint64_t bits() { return random_.bits(); }
  bool chance(double share) { return random_.unit() < share; }
  // least … most, both included.
  int between(int least, int most) {
    return least + int(random_.unit() * (double(most) - least + 1));
  }
  double uniform(double least, double most) { return least + (most - least) * random_.unit(); }
  // Every decade alike; 0 < least <= most.
  double decades(double least, double most) {
    return least * std::pow(most / least, random_.unit());
  }
  // Each component within ±size.
  Vec3 vector(double size) {
    Vec3 v{};
    for (double& c : v) c = size * random_.symmetric();
    return v;
  }
  template <class T>
  T of(std::initializer_list<T> values) {
    return values.begin()[between(0, int(values.size()) - 1)];
  }

 private:
  weft::Random random_;
};

}  // namespace fuzz
