// What of a scene is only drawn. Colours are "#rrggbb" of displays, whose values are not in proportion to light
// (IEC 61966-2-1).
#include <algorithm>
#include <charconv>
#include <cmath>

#include "weft/scene.h"

namespace weft {

std::optional<std::array<double, 3>> linear_color(const std::string& text) {
  if (text.size() != 7 || text[0] != '#') return {};
  std::array<double, 3> linear{};
  for (std::size_t k = 0; k < 3; ++k) {
    unsigned part = 0;
    const char *from = text.data() + 1 + 2 * k, *to = from + 2;
    if (std::from_chars(from, to, part, 16).ptr != to) return {};
    const double c = part / 255.0;
    linear[k] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return linear;
}

void draw_as(const Scene& from, Scene& to) {
  to.name = from.name;
  to.about = from.about;
  to.camera = from.camera;
  for (std::size_t c = 0; c < std::min(from.cloths.size(), to.cloths.size()); ++c)
    to.cloths[c].color = from.cloths[c].color;
  for (std::size_t c = 0; c < std::min(from.colliders.size(), to.colliders.size()); ++c)
    to.colliders[c].color = from.colliders[c].color;
}

bool moves_alike(const Scene& a, Scene b) {
  draw_as(a, b);
  return a == b;
}

}  // namespace weft
