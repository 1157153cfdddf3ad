// The colours of several cloths.
#include "picture/look.h"

#include <algorithm>
#include <cmath>

namespace weft::viewer {

namespace {

// Turns the hue: the colour about the axis of greys (Rodrigues). What no display shows is cut off.
Vec3f turned(Vec3f color, float angle) {
  const Vec3f axis = normalized({1, 1, 1});
  const Vec3f c = color * std::cos(angle) + cross(axis, color) * std::sin(angle) +
                  axis * (dot(axis, color) * (1 - std::cos(angle)));
  return {std::max(c.x, 0.0f), std::max(c.y, 0.0f), std::max(c.z, 0.0f)};
}

}  // namespace

ClothColors colors_of(const LookSettings& settings, std::size_t cloth) {
  constexpr float kGoldenAngle = 2.399963f;  // no two of a few hues come near each other
  if (cloth > 0 && cloth <= settings.other_colors.size()) return settings.other_colors[cloth - 1];
  const float angle = kGoldenAngle * static_cast<float>(cloth);
  return {turned(settings.colors.front, angle), turned(settings.colors.back, angle)};
}

void choose_colors(LookSettings& settings, std::size_t cloth, const ClothColors& colors) {
  if (cloth == 0) {
    settings.colors = colors;
    return;
  }
  while (settings.other_colors.size() < cloth)
    settings.other_colors.push_back(colors_of(settings, settings.other_colors.size() + 1));
  settings.other_colors[cloth - 1] = colors;
}

}  // namespace weft::viewer
