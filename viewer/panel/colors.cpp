#include "panel/colors.h"

#include <imgui.h>

#include <array>
#include <cmath>
#include <cstdio>

namespace weft::viewer {

std::optional<std::string> pick_color(const std::string& label, const std::string& shown) {
  std::array<float, 3> parts{};
  for (std::size_t k = 0; k < parts.size(); ++k)
    parts[k] = static_cast<float>(std::stoi(shown.substr(1 + 2 * k, 2), nullptr, 16)) / 255;
  if (!ImGui::ColorEdit3(label.c_str(), parts.data(), ImGuiColorEditFlags_NoInputs)) return {};
  std::array<char, 32> text{};
  const auto part = [&](std::size_t k) { return static_cast<int>(std::lround(255 * parts[k])); };
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", part(0), part(1), part(2));
  return text.data();
}

}  // namespace weft::viewer
