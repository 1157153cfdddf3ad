// Seed 000's parameters and the course's by their names, for the scenes of their kinds.
#include "edit/spring_cloth.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "edit/course_cloth.h"
#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {
namespace {

constexpr const char* kTypes[] = {"Positional", "Spring", "Spring and Friction"};

void number(const char* label, double& value, double low, double high, const char* help) {
  const float speed = 0.005f * static_cast<float>(std::max(std::abs(value), 0.01));
  ImGui::DragScalar(label, ImGuiDataType_Double, &value, speed, &low, &high, "%.4g",
                    ImGuiSliderFlags_AlwaysClamp);
  mark(label);
  tooltip(help);
}

void number(const char* label, int& value, int low, int high, const char* help) {
  ImGui::DragInt(label, &value, 0.1f, low, high, "%d", ImGuiSliderFlags_AlwaysClamp);
  mark(label);
  tooltip(help);
}

struct Number {
  const char* label;
  double& value;
  double low, high;
  const char* help;
};
struct Switch {
  const char* label;
  bool& on;
};

void type_of_constraint(Method& type) {
  const int now = type == Method::positional ? 0 : type == Method::spring ? 1 : 2;
  if (ImGui::BeginCombo("type of constraint", kTypes[now])) {
    for (const auto& [name, method] : {std::pair{kTypes[0], Method::positional},
                                       {kTypes[1], Method::spring},
                                       {kTypes[2], Method::spring_friction}})
      if (ImGui::Selectable(name, method == type)) type = method;
    ImGui::EndCombo();
  }
  mark("type of constraint");
}

}  // namespace

void draw_spring_cloth(Workspace& workspace) {
  const Scene& scene = workspace.document().scene();
  if (!is_spring_cloth(scene) || scene.solver.method == Method::compliant) return;
  const bool open = ImGui::CollapsingHeader("spring cloth (seed 000)");
  mark("spring cloth");
  if (!open) return;
  ImGui::PushItemWidth(ImGui::GetFontSize() * 9.5f);
  const SpringCloth now = spring_cloth_of(scene);
  SpringCloth s = now;
  number("cloth dim", s.cloth_dim, 3, 200, "Particles along each side; the sheet starts anew");
  number("particle offset [m]", s.particle_offset, 0.01, 1, "Between neighbours");
  number("particle mass [kg]", s.particle_mass, 1e-3, 100, "Of every particle");
  number("gravity force [m/s²]", s.gravity, -100, 100, "Upward: negative pulls down");
  type_of_constraint(s.type);
  if (s.type == Method::positional)
    number("K", s.k, 0, 0.5, "Share of the error that each end takes");
  else
    number("K [N/m]", s.k, 0, 1e4,
           "Of one iteration: the spring's stiffness is K times the iterations");
  if (s.type == Method::spring_friction)
    number("U [N s/m]", s.u, 0, 100, "Damping along the spring, of one iteration");
  number("constraint iteration", s.constraint_iterations, 1, 100,
         "Sweeps, or how often a step adds each spring's force");
  number("constraint level", s.constraint_level, 1, 8, "Neighbours up to this distance are joined");
  number("collision iteration", s.collision_iterations, 1, 100, "Passes over the bodies in a step");
  number("offset multiplier", s.offset_multiplier, 1, 2, "Of the spheres' radii");
  number("cut length", s.cut_length, 0, 20,
         "Times its rest length, past which a constraint is cut; 0 to 1: none is");
  ImGui::PopItemWidth();
  if (!(s == now)) workspace.edit(changes_to(scene, s), ImGui::IsAnyItemActive(), "spring cloth");
}

void draw_course_cloth(Workspace& workspace, const Parameters& parameters) {
  const Scene& scene = workspace.document().scene();
  if (!is_course_cloth(scene)) return;
  const CourseCloth now = course_cloth_of(scene);
  CourseCloth c = now;
  const Number numbers[] = {
      {"ks [N/m]", c.ks, 1e-3, 1e9,
       "Of structural and shearing springs; bending springs have a fifth"},
      {"density [g/cm²]", c.density, 1e-7, 1e5, "Ten times as many kg/m², as files have it"},
      {"damping [%]", c.damping, 0, 100,
       "Of the velocity, lost in each of the 2700 steps of a second"},
      {"gravity [m/s²]", c.gravity, -100, 100, "Upward: negative pulls down"},
      {"thickness [m]", c.thickness, 1e-5, 0.5, "Layers are kept twice as far apart"},
  };
  const Switch springs[] = {{"structural springs", c.structural},
                            {"shearing springs", c.shearing},
                            {"bending springs", c.bending}};
  const auto found = [&](const auto& control) { return parameters.shows(control.label); };
  if (std::none_of(std::begin(numbers), std::end(numbers), found) &&
      std::none_of(std::begin(springs), std::end(springs), found))
    return;
  if (parameters.searching()) ImGui::SetNextItemOpen(true);
  const bool open = ImGui::CollapsingHeader("course cloth", ImGuiTreeNodeFlags_DefaultOpen);
  mark("course cloth");
  if (!open) return;
  ImGui::PushID("course");
  ImGui::PushItemWidth(ImGui::GetFontSize() * 9.5f);
  std::string changed;
  for (const Number& n : numbers) {
    if (!found(n)) continue;
    const double before = n.value;
    number(n.label, n.value, n.low, n.high, n.help);
    if (n.value != before)
      changed = std::string(n.label).substr(0, std::string(n.label).find(" ["));
  }
  for (const Switch& s : springs) {
    if (!found(s)) continue;
    if (ImGui::Checkbox(s.label, &s.on)) changed = s.label;
    mark(s.label);
  }
  ImGui::PopItemWidth();
  ImGui::PopID();
  if (!(c == now))
    workspace.edit(changes_between(scene, with(scene, c)), ImGui::IsAnyItemActive(), changed);
}

}  // namespace weft::viewer
