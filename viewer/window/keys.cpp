// Names of keys, and reading of the file.
#include "window/keys.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <optional>

namespace weft::viewer {

// In the order of Action.
const std::array<ActionText, kActions> kActionTexts{{
    {"quit", "Ctrl+Q", "Leave"},
    {"close", "Esc", "Close a list or the help"},
    {"pause", "P, Space", "Pause or go on"},
    {"step", "N", "One frame"},
    {"reset", "R", "Start the scene anew"},
    {"frame", "F", "Show all of the cloth"},
    {"home", "Home", "The view that the scene opened with"},
    {"front", "Alt+1", "Look from the front"},
    {"side", "Alt+2", "Look from the right"},
    {"top", "Alt+3", "Look from above"},
    {"gallery", "G", "All scenes as pictures"},
    {"help", "H, F1", "These keys"},
    {"panel", "Tab", "Hide or show the panel"},
    {"undo", "Ctrl+Z", "Undo a change"},
    {"redo", "Ctrl+Y, Ctrl+Shift+Z", "Redo it"},
    {"save", "Ctrl+S", "Save the scene as edited"},
    {"next_look", "L", "Next look"},
    {"previous_look", "Shift+L", "Previous look"},
    {"next_scene", "PageDown", "Next scene"},
    {"previous_scene", "PageUp", "Previous scene"},
    {"faster", "Period", "Twice as fast"},
    {"slower", "Comma", "Half as fast"},
    {"back", "B", "Go back in time"},
    {"forward", "Shift+B", "Forward again"},
    {"screenshot", "F12", "Picture of the view"},
    {"film", "F11", "Start or end a film"},
    {"hand", "1", "Tool: drag the cloth"},
    {"pin", "2", "Tool: pin and unpin"},
    {"cut", "3", "Tool: cut"},
    {"move", "4", "Tool: move cloths and bodies"},
    {"ball", "5", "Tool: shoot a ball"},
    {"move_left", "Left", "Move body or cloth left"},
    {"move_right", "Right", "Move it right"},
    {"move_near", "Down", "Move it nearer"},
    {"move_far", "Up", "Move it away"},
    {"move_up", "E", "Move it up"},
    {"move_down", "D", "Move it down"},
    {"duplicate", "Ctrl+D", "The chosen cloth or body once more"},
    {"delete", "Delete", "Take the chosen cloth or body away"},
}};

namespace {

struct KeyName {
  std::string_view name;
  int key;
};
constexpr KeyName kNamed[] = {{"Esc", GLFW_KEY_ESCAPE},
                              {"Space", GLFW_KEY_SPACE},
                              {"Tab", GLFW_KEY_TAB},
                              {"Enter", GLFW_KEY_ENTER},
                              {"Left", GLFW_KEY_LEFT},
                              {"Right", GLFW_KEY_RIGHT},
                              {"Up", GLFW_KEY_UP},
                              {"Down", GLFW_KEY_DOWN},
                              {"PageUp", GLFW_KEY_PAGE_UP},
                              {"PageDown", GLFW_KEY_PAGE_DOWN},
                              {"Home", GLFW_KEY_HOME},
                              {"End", GLFW_KEY_END},
                              {"Insert", GLFW_KEY_INSERT},
                              {"Delete", GLFW_KEY_DELETE},
                              {"Backspace", GLFW_KEY_BACKSPACE},
                              {"Comma", GLFW_KEY_COMMA},
                              {"Period", GLFW_KEY_PERIOD},
                              {"Minus", GLFW_KEY_MINUS},
                              {"Plus", GLFW_KEY_EQUAL},
                              {"Slash", GLFW_KEY_SLASH}};
constexpr KeyName kModifiers[] = {
    {"Ctrl", GLFW_MOD_CONTROL}, {"Shift", GLFW_MOD_SHIFT}, {"Alt", GLFW_MOD_ALT}};
constexpr int kAllModifiers = GLFW_MOD_CONTROL | GLFW_MOD_SHIFT | GLFW_MOD_ALT;

bool same(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                            [&](char x, char y) { return lower(x) == lower(y); });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())))
    text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())))
    text.remove_suffix(1);
  return text;
}

int key_of(std::string_view name) {
  for (const KeyName& known : kNamed)
    if (same(name, known.name)) return known.key;
  if (name.size() == 1) {
    const int c = std::toupper(static_cast<unsigned char>(name[0]));
    if (std::isalnum(c)) return c;  // GLFW's numbers of letters and digits are ASCII's
  }
  if (name.size() > 1 && name.size() < 4 && (name[0] == 'F' || name[0] == 'f')) {
    const int n = std::atoi(std::string(name.substr(1)).c_str());
    if (n >= 1 && n <= 12) return GLFW_KEY_F1 + n - 1;
  }
  return 0;
}

std::string name_of(int key, int mods) {
  std::string name;
  for (const KeyName& m : kModifiers)
    if ((mods & m.key) != 0) name += std::string(m.name) + "+";
  for (const KeyName& known : kNamed)
    if (known.key == key) return name + std::string(known.name);
  if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12)
    return name + "F" + std::to_string(key - GLFW_KEY_F1 + 1);
  return name + static_cast<char>(key);
}

// Calls each(part) for the parts between the separators.
template <class Each>
void split(std::string_view text, char separator, Each each) {
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(separator, start), text.size());
    each(trimmed(text.substr(start, end - start)));
    start = end + 1;
  }
}

template <class Binding>
std::optional<Binding> binding_of(std::string_view text) {
  Binding binding;
  bool good = true;
  split(text, '+', [&](std::string_view part) {
    for (const KeyName& m : kModifiers)
      if (same(part, m.name)) {
        binding.mods |= m.key;
        return;
      }
    good = good && binding.key == 0;
    binding.key = key_of(part);
  });
  if (!good || binding.key == 0) return std::nullopt;
  return binding;
}

}  // namespace

Keys::Keys() {
  for (std::size_t a = 0; a < kActions; ++a)
    split(kActionTexts[a].keys, ',',
          [&](std::string_view text) { bindings_[a].push_back(*binding_of<Binding>(text)); });
}

std::vector<std::string> Keys::read(const std::string& path) {
  std::vector<std::string> wrong;
  std::ifstream file(path);
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::string_view text = trimmed(std::string_view(line).substr(0, line.find('#')));
    if (text.empty()) continue;
    const std::string place = path + ":" + std::to_string(number) + ": ";
    const std::size_t equals = text.find('=');
    const std::string_view name = trimmed(text.substr(0, equals));
    const auto found = std::find_if(kActionTexts.begin(), kActionTexts.end(),
                                    [&](const ActionText& a) { return same(a.name, name); });
    if (equals == std::string_view::npos || found == kActionTexts.end()) {
      wrong.push_back(place + "'" + std::string(name) + "' is no action (action = Key, Ctrl+Key)");
      continue;
    }
    std::vector<Binding> bindings;
    split(text.substr(equals + 1), ',', [&](std::string_view key) {
      if (const auto binding = binding_of<Binding>(key))
        bindings.push_back(*binding);
      else
        wrong.push_back(place + "'" + std::string(key) +
                        "' is no key (a letter, a digit, F1 to F12, or a name such as PageUp)");
    });
    if (!bindings.empty()) bindings_[std::size_t(found - kActionTexts.begin())] = bindings;
  }
  return wrong;
}

Action Keys::action_of(const KeyPress& press) const {
  for (std::size_t a = 0; a < kActions; ++a)
    for (const Binding& b : bindings_[a])
      if (b.key == press.key && b.mods == (press.mods & kAllModifiers))
        return static_cast<Action>(a);
  return Action::count;
}

bool Keys::held(Action action, const Window& window) const {
  const auto& bindings = bindings_[static_cast<std::size_t>(action)];
  return std::any_of(bindings.begin(), bindings.end(),
                     [&](const Binding& b) { return window.key_down(b.key, b.mods); });
}

std::string Keys::names_of(Action action) const {
  std::string names;
  for (const Binding& b : bindings_[static_cast<std::size_t>(action)])
    names += (names.empty() ? "" : ", ") + name_of(b.key, b.mods);
  return names;
}

std::string keys_file() {
  if (const char* chosen = std::getenv("WEFT_KEYS")) return chosen;
  if (const char* folder = std::getenv("XDG_CONFIG_HOME"))
    return std::string(folder) + "/weft/keys";
  if (const char* home = std::getenv("HOME")) return std::string(home) + "/.config/weft/keys";
  return "";
}

}  // namespace weft::viewer
