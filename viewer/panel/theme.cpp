// DejaVu Sans where it is installed, else Dear ImGui's own letters.
#include "panel/theme.h"

#include <filesystem>

namespace weft::viewer {

namespace {

constexpr const char* kFonts[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                  "/usr/share/fonts/dejavu/DejaVuSans.ttf",
                                  "/usr/share/fonts/TTF/DejaVuSans.ttf"};
// Latin, Greek, punctuation, arrows, mathematical and geometric signs.
constexpr ImWchar kLetters[] = {0x20,   0x17f,  0x370,  0x3ff,  0x2010, 0x2027, 0x2070, 0x209f,
                                0x2190, 0x21ff, 0x2200, 0x22ff, 0x25a0, 0x25ff, 0};

void set_font(float scale) {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  std::error_code error;
  for (const char* path : kFonts)
    if (std::filesystem::exists(path, error) &&
        fonts.AddFontFromFileTTF(path, 14 * scale, nullptr, kLetters) != nullptr)
      return;
  ImFontConfig config;
  config.SizePixels = 13 * scale;
  fonts.AddFontDefault(&config);
}

void set_colors(ImVec4* c) {
  const auto accent = [](float alpha) { return ImVec4(kAccent.x, kAccent.y, kAccent.z, alpha); };
  const auto light = [](float alpha) { return ImVec4(1, 1, 1, alpha); };
  c[ImGuiCol_Text] = {0.92f, 0.93f, 0.95f, 1};
  c[ImGuiCol_TextDisabled] = kQuiet;
  c[ImGuiCol_WindowBg] = {0.105f, 0.115f, 0.135f, 1};
  c[ImGuiCol_ChildBg] = {0, 0, 0, 0};
  c[ImGuiCol_PopupBg] = {0.13f, 0.14f, 0.165f, 0.98f};
  c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = {0.16f, 0.17f, 0.20f, 1};
  c[ImGuiCol_Border] = light(0.07f);
  c[ImGuiCol_FrameBg] = light(0.065f);
  c[ImGuiCol_FrameBgHovered] = light(0.11f);
  c[ImGuiCol_FrameBgActive] = light(0.15f);
  c[ImGuiCol_Button] = light(0.08f);
  c[ImGuiCol_ButtonHovered] = light(0.14f);
  c[ImGuiCol_ButtonActive] = accent(0.9f);
  c[ImGuiCol_Header] = light(0.06f);
  c[ImGuiCol_HeaderHovered] = light(0.11f);
  c[ImGuiCol_HeaderActive] = light(0.15f);
  c[ImGuiCol_SliderGrab] = accent(0.85f);
  c[ImGuiCol_SliderGrabActive] = accent(1);
  c[ImGuiCol_CheckMark] = accent(1);
  c[ImGuiCol_Tab] = light(0.04f);
  c[ImGuiCol_TabHovered] = accent(0.55f);
  c[ImGuiCol_TabActive] = accent(0.75f);
  c[ImGuiCol_Separator] = light(0.08f);
  c[ImGuiCol_ScrollbarBg] = {0, 0, 0, 0};
  c[ImGuiCol_ScrollbarGrab] = light(0.16f);
  c[ImGuiCol_ScrollbarGrabHovered] = light(0.24f);
  c[ImGuiCol_ScrollbarGrabActive] = light(0.32f);
  c[ImGuiCol_TextSelectedBg] = accent(0.4f);
  c[ImGuiCol_PlotLines] = accent(1);
  c[ImGuiCol_PlotHistogram] = accent(0.8f);
  c[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, 0.45f};
}

}  // namespace

void set_theme(float scale) {
  set_font(scale);
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {6, 4};
  style.ScrollbarSize = 11;
  style.GrabMinSize = 10;
  style.WindowRounding = 8;
  style.FrameRounding = 5;
  style.PopupRounding = 6;
  style.ScrollbarRounding = 6;
  style.GrabRounding = 4;
  style.TabRounding = 5;
  style.WindowBorderSize = 0;
  style.FrameBorderSize = 0;
  style.ScaleAllSizes(scale);
  set_colors(style.Colors);
}

void mark(const std::string& name, ImVec2 at) {
  if (auto* landmarks = static_cast<Landmarks*>(ImGui::GetIO().UserData)) (*landmarks)[name] = at;
}

void mark(const std::string& name) {
  if (!ImGui::IsItemVisible()) return;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  mark(name, {(low.x + high.x) / 2, (low.y + high.y) / 2});
}

void heading(const char* text) {
  ImGui::Dummy({0, 2});
  ImGui::PushStyleColor(ImGuiCol_Text, kQuiet);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
}

void tooltip(const char* text) {
  if (text == nullptr || *text == '\0' ||
      !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
    return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace weft::viewer
