// A gas within a cloth (weft/scene.h).
#pragma once

#include <vector>

namespace weft {

// At `time` [s] so many times as much; linear in between, held before the first and after the last. Times
// increase strictly.
struct Share {
  double time = 0;
  double value = 1;  // 0 … 1000
  friend bool operator==(const Share&, const Share&) = default;
};

// The gas in a closed mesh, or in one that seams close. It pushes along the outer normals with `over`, whatever
// the volume; or, where `inflate` is above 0, with what an ideal gas of constant temperature has above the air
// about it: as much gas as fills `inflate` times the volume V0 that the mesh encloses as it starts,
// p = ambient (inflate V0 / V - 1).
struct Pressure {
  double over = 0;            // Pa
  double inflate = 0;         // 0 … 1000
  double ambient = 101325;    // Pa, of the air about it
  std::vector<Share> keys{};  // of over, or of the amount of gas
  bool given() const { return over != 0 || inflate > 0; }
  friend bool operator==(const Pressure&, const Pressure&) = default;
};

}  // namespace weft
