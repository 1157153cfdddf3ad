// What the corners of a triangle keep of it where some of its edges have torn, as triangles to draw: tears cross
// edges, and each corner has the part on its side.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace weft::physics {

// A point's number; none: where nothing tells how the cloth lies on its side, nothing is drawn.
using TornPoint = std::optional<std::uint32_t>;

// `gone`: bit n of the edge from corner n to the next. own(a): corner a. end(a, b): where the tear crosses the
// edge to b, as seen from a. middle(a, b, c): the middle of the triangle as seen from a. Calls add() for each
// triangle of points.
template <class Corner, class Own, class End, class Middle, class Add>
void share_torn_triangle(const std::array<Corner, 3>& corner, unsigned gone, const Own& own,
                         const End& end, const Middle& middle, const Add& add) {
  for (std::size_t n = 0; n < 3; ++n) {
    const Corner &a = corner[n], &b = corner[(n + 1) % 3], &c = corner[(n + 2) % 3];
    const bool ab = gone >> n & 1, bc = gone >> (n + 1) % 3 & 1, ca = gone >> (n + 2) % 3 & 1;
    if (ab && !bc && !ca) {
      add({own(a), end(a, b), own(c)});
      add({end(b, a), own(b), own(c)});
    } else if (ab && ca && !bc) {
      add({own(a), end(a, b), end(a, c)});
      const TornPoint near_b = end(b, a);
      add({near_b, own(b), own(c)});
      add({near_b, own(c), end(c, a)});
    } else if (ab && bc && ca) {
      const TornPoint center = middle(a, b, c);
      add({own(a), end(a, b), center});
      add({own(a), center, end(a, c)});
    }
  }
}

}  // namespace weft::physics
