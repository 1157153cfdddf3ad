// Which keys do what: one table of actions, their standard keys, and the file that remaps them.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "window/window.h"

namespace weft::viewer {

enum class Action {
  quit,
  close,
  pause,
  step,
  reset,
  frame,
  home,
  front,
  side,
  top,
  gallery,
  help,
  panel,
  undo,
  redo,
  save,
  next_look,
  previous_look,
  next_scene,
  previous_scene,
  faster,
  slower,
  back,
  forward,
  screenshot,
  film,
  hand,
  pin,
  cut,
  move,
  ball,
  move_left,
  move_right,
  move_near,
  move_far,
  move_up,
  move_down,
  duplicate,
  remove,
  count
};
inline constexpr auto kActions = static_cast<std::size_t>(Action::count);

struct ActionText {
  std::string_view name;  // in the file of keys
  std::string_view keys;  // the standard ones
  std::string_view about;
};
extern const std::array<ActionText, kActions> kActionTexts;

class Keys {
 public:
  Keys();  // the standard ones

  // Lines "action = Key, Ctrl+Key"; # starts a comment. Returns what is wrong, line by line; the
  // other lines count.
  std::vector<std::string> read(const std::string& path);

  // The action of a key press; Action::count when it has none.
  Action action_of(const KeyPress& press) const;
  // Whether one of the action's keys is down now; Shift does not matter.
  bool held(Action action, const Window& window) const;
  // "P, Space"
  std::string names_of(Action action) const;

 private:
  struct Binding {
    int key = 0, mods = 0;
  };
  std::array<std::vector<Binding>, kActions> bindings_;
};

// The file of a person's own keys: $WEFT_KEYS, else weft/keys in the configuration folder.
std::string keys_file();

}  // namespace weft::viewer
