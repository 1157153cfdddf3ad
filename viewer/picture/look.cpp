// The colours of several cloths.
#include "picture/look.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace weft::viewer {

namespace {

// Turns the hue: the colour about the axis of greys (Rodrigues). What no display shows is cut off.
Vec3f turned(Vec3f color, float angle) {
  const Vec3f axis = normalized({1, 1, 1});
  const Vec3f c = color * std::cos(angle) + cross(axis, color) * std::sin(angle) +
                  axis * (dot(axis, color) * (1 - std::cos(angle)));
  return {std::max(c.x, 0.0f), std::max(c.y, 0.0f), std::max(c.z, 0.0f)};
}

// As scenes have it.
std::string text_of(Vec3f linear) {
  const auto encode = [](float c) {
    const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
    return static_cast<int>(std::lround(255 * std::clamp(s, 0.0f, 1.0f)));
  };
  char text[32];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", encode(linear.x), encode(linear.y),
                encode(linear.z));
  return text;
}

}  // namespace

ClothColors colors_of(const Cloth& cloth, std::size_t number) {
  constexpr float kGoldenAngle = 2.399963f;  // no two of a few hues come near each other
  const float angle = kGoldenAngle * static_cast<float>(number);
  ClothColors colors;
  colors = {turned(colors.front, angle), turned(colors.back, angle)};
  if (const auto front = linear_color(cloth.color.front))
    colors.front = colors.back = to_float(*front);
  if (const auto back = linear_color(cloth.color.back)) colors.back = to_float(*back);
  return colors;
}

Vec3f color_of(const Collider& body) {
  const auto given = linear_color(body.color);
  return given ? to_float(*given) : kBodyColor;
}

std::string drawn_color(const Scene& scene, const std::string& place) {
  const std::size_t number = std::stoul(place.substr(place.find('/', 1) + 1));
  if (place.starts_with("/colliders/")) return text_of(color_of(scene.colliders[number]));
  const ClothColors colors = colors_of(scene.cloths[number], number);
  return text_of(place.ends_with("/front") ? colors.front : colors.back);
}

}  // namespace weft::viewer
