// How the panel looks: its letters and colours.
#pragma once

#include <imgui.h>

#include <map>
#include <string>

namespace weft::viewer {

// Sets Dear ImGui's style; `scale` is that of the display.
void set_theme(float scale);

inline const ImVec4 kAccent{0.93f, 0.46f, 0.36f, 1};
inline const ImVec4 kQuiet{0.60f, 0.63f, 0.68f, 1};
inline const ImVec4 kGood{0.45f, 0.80f, 0.60f, 1};
inline const ImVec4 kBad{0.98f, 0.45f, 0.42f, 1};
inline const ImVec4 kRunning{0.78f, 0.16f, 0.16f, 1};

// Where controls are, by name: for whoever drives the window by a script. Kept only when
// ImGui::GetIO().UserData points to one.
using Landmarks = std::map<std::string, ImVec2>;
// Notes the middle of the control just drawn.
void mark(const std::string& name);
// The same of what is no control, by its place.
void mark(const std::string& name, ImVec2 at);

// A heading above a group of controls.
void heading(const char* text);
// Explains the control just drawn while the pointer rests on it.
void tooltip(const char* text);

}  // namespace weft::viewer
