// Controls by the type that the schema names.
#include "panel/parameters.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

#include "edit/forms.h"
#include "panel/colors.h"
#include "panel/panel.h"
#include "panel/theme.h"
#include "scene/schema.h"

namespace weft::viewer {

namespace {

std::string words_of(std::string key) {
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

std::string label_of(const std::string& key, const text::Json& schema) {
  const text::Json* unit = text::member(schema, "x-unit");
  return words_of(key) + (unit ? " [" + unit->get<std::string>() + "]" : "");
}

// What the tooltip tells: the help, the range, the place.
std::string help_of(const std::string& pointer, const text::Json& schema) {
  std::string help;
  if (const text::Json* about = text::member(schema, "description"))
    help = about->get<std::string>();
  const text::Json& bounds = schema.contains("items") ? schema["items"] : schema;
  if (bounds.contains("minimum")) help += "\n" + text::range_words(bounds);
  return help + "\n" + pointer;
}

double bound(const text::Json& schema, const char* key, double standard) {
  const text::Json* value = text::member(schema, key);
  return value ? value->get<double>() : standard;
}

bool is_type(const text::Json& schema, std::string_view type) {
  const text::Json* name = text::member(schema, "type");
  return name && *name == type;
}

// A drag changes a value by about its own size over the width of the control.
float speed_of(double value, double low, double high) {
  const double size = std::max(std::abs(value), std::min(1e-3, (high - low) * 1e-3));
  return static_cast<float>(std::min(size, high - low) * 0.006);
}

}  // namespace

void Parameters::change(const std::string& pointer, const Json& value) {
  workspace_->edit({{pointer, value}}, moved_ == pointer);
  moved_ = ImGui::IsAnyItemActive() ? pointer : "";
}

// A word is looked for in a name, a place ("/cloths/0/grid", as messages have it) from its start.
bool Parameters::named(const std::string& pointer, const std::string& key) const {
  if (filter_.starts_with('/')) return pointer.starts_with(filter_);
  const std::string text = words_of(key);
  return std::search(text.begin(), text.end(), filter_.begin(), filter_.end(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) ==
                  std::tolower(static_cast<unsigned char>(b));
         }) != text.end();
}

// Whether a value, or one within, has what is looked for in its name; all within a group that has it do.
bool Parameters::passes(const std::string& pointer, const std::string& key,
                        const Json& schema) const {
  if (whole_ || filter_.empty() || named(pointer, key) || filter_.starts_with(pointer + "/"))
    return true;
  const Json* properties = text::member(schema, "properties");
  if (!properties) return false;
  return std::any_of(properties->items().begin(), properties->items().end(), [&](const auto& item) {
    return passes(text::join(pointer, item.key()), item.key(), item.value());
  });
}

void Parameters::number(const std::string& pointer, const std::string& label, const Json& schema,
                        const Json& value) {
  const double low = bound(schema, "minimum", -1e9), high = bound(schema, "maximum", 1e9);
  if (is_type(schema, "integer")) {
    int shown = value.get<int>();
    const int least = static_cast<int>(low), most = static_cast<int>(high);
    if (ImGui::DragInt(label.c_str(), &shown, std::max(0.1f, 0.01f * static_cast<float>(shown)),
                       least, most, "%d", ImGuiSliderFlags_AlwaysClamp))
      change(pointer, shown);
    return;
  }
  double shown = value.get<double>();
  if (ImGui::DragScalar(label.c_str(), ImGuiDataType_Double, &shown, speed_of(shown, low, high),
                        &low, &high, "%.5g", ImGuiSliderFlags_AlwaysClamp))
    change(pointer, shown);
}

void Parameters::numbers(const std::string& pointer, const std::string& label, const Json& schema,
                         const Json& value) {
  const Json& item = schema["items"];
  const double low = bound(item, "minimum", -1e9), high = bound(item, "maximum", 1e9);
  const int count = static_cast<int>(value.size());
  if (is_type(item, "integer")) {
    auto shown = value.get<std::vector<int>>();
    const int least = static_cast<int>(low), most = static_cast<int>(high);
    if (ImGui::DragScalarN(label.c_str(), ImGuiDataType_S32, shown.data(), count, 0.2f, &least,
                           &most, "%d", ImGuiSliderFlags_AlwaysClamp))
      change(pointer, shown);
    return;
  }
  auto shown = value.get<std::vector<double>>();
  double size = 0.05;
  for (const double component : shown) size = std::max(size, std::abs(component));
  if (ImGui::DragScalarN(label.c_str(), ImGuiDataType_Double, shown.data(), count,
                         speed_of(size, low, high), &low, &high, "%.4g",
                         ImGuiSliderFlags_AlwaysClamp))
    change(pointer, shown);
}

void Parameters::choice(const std::string& pointer, const std::string& label, const Json& schema,
                        const Json& value) {
  const auto& now = value.get_ref<const std::string&>();
  if (!ImGui::BeginCombo(label.c_str(), words_of(now).c_str())) return;
  for (const Json& name : schema["enum"]) {
    const auto& word = name.get_ref<const std::string&>();
    if (ImGui::Selectable(words_of(word).c_str(), word == now)) change(pointer, word);
  }
  ImGui::EndCombo();
}

// Of a cloth or a body as a whole.
void Parameters::part_buttons(const std::string& pointer) {
  const bool cloth = pointer.starts_with("/cloths/");
  const Part part{cloth ? Kind::cloth : Kind::body,
                  std::stoul(pointer.substr(pointer.rfind('/') + 1))};
  const Scene& scene = workspace_->document().scene();
  ImGui::PushID(pointer.c_str());
  if (ImGui::SmallButton("Duplicate")) copied_ = part;
  mark(pointer + " duplicate");
  ImGui::SameLine();
  ImGui::BeginDisabled(cloth && scene.cloths.size() == 1);
  if (ImGui::SmallButton("Delete")) removed_ = part;
  ImGui::EndDisabled();
  mark(pointer + " delete");
  tooltip(cloth && scene.cloths.size() == 1 ? "A scene has one cloth at least" : "");
  ImGui::PopID();
}

// A number, or auto.
void Parameters::substeps(const std::string& pointer, const std::string& label, const Json& schema,
                          const Json& value) {
  bool automatic = value.is_string();
  if (ImGui::Checkbox("auto", &automatic)) change(pointer, automatic ? Json("auto") : Json(20));
  ImGui::SameLine();
  ImGui::BeginDisabled(automatic);
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - ImGui::GetFontSize() * 4.6f);
  const int used = workspace_->telemetry().substeps;
  number(pointer, label, schema["oneOf"][0], automatic ? Json(used) : value);
  ImGui::EndDisabled();
}

// A button for what else the value may be: a number apart for each direction, a vector over time.
void Parameters::form(const std::string& pointer, const Json& forms, const Json& value,
                      const Json& chosen) {
  ImGui::PushID(pointer.c_str());
  if (ImGui::SmallButton("…")) ImGui::OpenPopup("form");
  mark(pointer + " form");
  tooltip("As one value, apart, or over time");
  if (ImGui::BeginPopup("form")) {
    for (const Json& to : forms) {
      const std::string name = name_of_form(to);
      if (ImGui::Selectable(name.c_str(), &to == &chosen) && &to != &chosen)
        change(pointer, in_form(value, forms[0], to));
      mark(pointer + " " + name);
    }
    ImGui::EndPopup();
  }
  ImGui::PopID();
}

// One line of text, taken with Enter.
void Parameters::word(const std::string& pointer, const std::string& label, const Json& value) {
  std::string text = value.get<std::string>();
  if (ImGui::InputText(label.c_str(), &text, ImGuiInputTextFlags_EnterReturnsTrue))
    change(pointer, text);
}

// A swatch, and the text, empty where it is a standard colour.
void Parameters::color(const std::string& pointer, const std::string& label, const Json& value) {
  const std::string swatch = pointer + " swatch";
  const auto chosen =
      pick_color("##" + swatch, drawn_color(workspace_->document().scene(), pointer));
  mark(swatch);
  if (chosen) change(pointer, *chosen);
  const float width = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - width);
  word(pointer, label, value);
}

// The control of a value that is no list of its own kind; false when it is one.
bool Parameters::plain(const std::string& pointer, const std::string& label, const Json& schema,
                       const Json& value) {
  if (value.is_boolean()) {
    bool on = value.get<bool>();
    if (ImGui::Checkbox(label.c_str(), &on)) change(pointer, on);
  } else if (schema.contains("enum")) {
    choice(pointer, label, schema, value);
  } else if (schema.contains("format")) {
    color(pointer, label, value);
  } else if (value.is_string()) {
    word(pointer, label, value);
  } else if (value.is_number()) {
    number(pointer, label, schema, value);
  } else if (value.is_array() && !value.empty() && value.size() <= 3 && value[0].is_number()) {
    numbers(pointer, label, schema, value);
  } else {
    return false;
  }
  return true;
}

void Parameters::member(const std::string& pointer, const std::string& key, const Json& schema,
                        const Json& value) {
  const std::string label = label_of(key, schema) + "##" + pointer;
  const Json* options = text::member(schema, "oneOf");
  const Json& chosen = *text::alternative(schema, value);
  const bool forms = options && options->size() > 1 && key != "substeps" && key != "rest";
  if (value.is_object()) {
    if (forms) form(pointer, *options, value, chosen);
    if (forms) ImGui::SameLine();
    group(pointer, words_of(key), chosen, value, false);
    return;
  }
  if (value.is_array() && list(pointer, key, value)) return;
  if (key == "substeps")
    substeps(pointer, label, schema, value);
  else if (!plain(pointer, label, chosen, value))
    as_text(pointer, words_of(key), value);
  mark(pointer);
  tooltip(help_of(pointer, schema).c_str());
  if (forms) ImGui::SameLine();
  if (forms) form(pointer, *options, value, chosen);
  if (key == "particle_mass") area_density(pointer);
}

// What the cloth weighs, in the units of files and of the course (15 g/cm² = 150 kg/m²).
void Parameters::area_density(const std::string& pointer) {
  const std::size_t number = std::stoul(pointer.substr(std::string("/cloths/").size()));
  const Cloth& cloth = workspace_->document().scene().cloths[number];
  if (cloth.mesh.given()) return;
  const double density = weft::area_density(cloth);
  ImGui::TextColored(kQuiet, "a particle's square: %.4g kg/m² = %.4g g/cm²", density, density / 10);
}

void Parameters::members(const std::string& pointer, const Json& schema, const Json& value) {
  for (auto it = value.begin(); it != value.end(); ++it) {
    const Json* known = text::descend(schema, &value, it.key());
    const std::string place = text::join(pointer, it.key());
    if (known && !known->contains("const") && passes(place, it.key(), *known))
      member(place, it.key(), *known, *it);
  }
}

void Parameters::group(const std::string& pointer, const std::string& title, const Json& schema,
                       const Json& value, bool open) {
  if (!filter_.empty()) ImGui::SetNextItemOpen(true);
  const std::string label = title + "##" + pointer;
  const bool top = std::count(pointer.begin(), pointer.end(), '/') <= 2;
  const ImGuiTreeNodeFlags flags = open ? ImGuiTreeNodeFlags_DefaultOpen : 0;
  const bool shown =
      top && (pointer.find('/', 1) == std::string::npos || title.find(' ') != std::string::npos)
          ? ImGui::CollapsingHeader(label.c_str(), flags)
          : ImGui::TreeNodeEx(label.c_str(), flags | ImGuiTreeNodeFlags_NoTreePushOnOpen);
  if (const Json* about = text::member(schema, "description"))
    tooltip(about->get_ref<const std::string&>().c_str());
  if (!shown) return;
  const bool whole = std::exchange(whole_, whole_ || (searching() && named(pointer, title)));
  ImGui::Indent(6);
  const bool part = pointer.starts_with("/cloths/") || pointer.starts_with("/colliders/");
  if (part && std::count(pointer.begin(), pointer.end(), '/') == 2) part_buttons(pointer);
  members(pointer, schema, value);
  ImGui::Unindent(6);
  whole_ = whole;
}

void Parameters::draw_search() {
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##filter", "find a parameter", &filter_);
  mark("filter");
}

void Parameters::draw(Workspace& workspace) {
  workspace_ = &workspace;
  if (!moved_.empty() && !ImGui::IsAnyItemActive()) moved_.clear();
  ImGui::PushItemWidth(ImGui::GetFontSize() * 9.5f);
  // Values of the document may change under the controls: they look at a copy. Parts come and go behind them.
  const Json json = workspace.document().json();
  const Json& schema = text::scene_schema_json();
  const auto top = [&](const char* key, bool open) {
    const Json& known = schema["properties"][key];
    if (passes(std::string("/") + key, key, known))
      group(std::string("/") + key, words_of(key), known, json[key], open);
  };
  top("solver", true);
  const auto single = [&](const char* key) {
    const Json& known = schema["properties"][key];
    const std::string place = std::string("/") + key;
    if (passes(place, key, known)) member(place, key, known, json[key]);
  };
  const Json& cloth = schema["properties"]["cloths"]["items"];
  const bool one = json["cloths"].size() == 1;
  for (std::size_t n = 0; n < std::min<std::size_t>(json["cloths"].size(), 20); ++n)
    if (const std::string place = "/cloths/" + std::to_string(n); passes(place, "cloth", cloth))
      group(place, one ? "cloth " : "cloth " + std::to_string(n), cloth, json["cloths"][n], n == 0);
  single("gravity");
  top("wind", false);
  top("time", false);
  top("camera", false);
  const Json& collider = schema["properties"]["colliders"]["items"];
  for (std::size_t n = 0; n < std::min<std::size_t>(json["colliders"].size(), 50); ++n) {
    std::string title = "collider " + std::to_string(n);
    for (const char* shape : kShapeNames)
      if (json["colliders"][n].contains(shape))
        title = std::string(shape) + " " + std::to_string(n);
    const std::string place = "/colliders/" + std::to_string(n);
    if (passes(place, "collider", collider))
      group(place, title, collider, json["colliders"][n], false);
  }
  single("name");
  single("about");
  ImGui::PopItemWidth();
  if (const auto part = std::exchange(copied_, {})) workspace.duplicate(*part);
  if (const auto part = std::exchange(removed_, {})) workspace.remove(*part);
  workspace_ = nullptr;
}

}  // namespace weft::viewer
