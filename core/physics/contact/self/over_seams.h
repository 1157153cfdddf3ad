// Triangles that seams of a mesh bring beside each other: those that have a seam's vertex in common, and those
// so near to the seam that contact would push them away where the cloth lies flat over it. They do not meet.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/contact/self/blocks.h"
#include "physics/contact/self/pair_search.h"
#include "physics/kernels/surface.h"

namespace weft::physics {

class OverSeams {
 public:
  // Bodies are named as in pair_search.h.
  OverSeams(const std::vector<Sheet>& sheets, const std::vector<NamedSheet>& named,
            std::size_t bodies);

  // Whether a seam brings a corner of one beside a corner of the other.
  bool join(const Square& one, const Square& other) const;
  std::size_t bytes() const;

 private:
  std::vector<std::vector<std::int32_t>>
      near_;  // of every body, ascending; empty: there are no seams
};

}  // namespace weft::physics
