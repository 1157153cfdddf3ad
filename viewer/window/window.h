// One window with an OpenGL 3.3 context and Dear ImGui in it; its events as plain data.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

struct GLFWwindow;

namespace weft::viewer {

// A key went down, in the order of typing; `again` when it is held and repeats.
struct KeyPress {
  int key = 0;   // GLFW_KEY_…
  int mods = 0;  // GLFW_MOD_…
  bool again = false;
};

class Window {
 public:
  // Throws Failure that says what is missing: a display, or OpenGL 3.3.
  Window(int width, int height, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // Takes in what happened, waiting at most `seconds` for something to happen.
  void poll(double seconds);
  bool closing() const;
  void close();
  void hide();
  void set_title(const std::string& title);

  int width() const { return width_; }  // pixels
  int height() const { return height_; }
  bool visible() const { return width_ > 0 && height_ > 0; }
  // The pixels of the screen for one of the panel's: 2 on a fine display.
  float scale() const { return scale_; }
  // Whether a key is down that was pressed with these of Ctrl, Alt and Super: D that comes up after the Ctrl of
  // Ctrl+D does not count as D.
  bool key_down(int key, int mods) const;

  // Whether keys, buttons or the pointer did anything since the last call, or the window must be drawn anew.
  bool take_stir();

  // Of the strokes told to the panel since the last call.
  std::vector<KeyPress> take_keys();
  std::vector<std::string> take_dropped();

  void begin_panel();
  // Draws the panel over what is there, and over its colour in the columns [pixels] left of `side`.
  void end_panel(int side);
  void swap();

 private:
  static constexpr int kButtons = 3;  // of the mouse: left, right, middle
  // A key or a button that changed, or a character.
  struct Stroke {
    enum Kind { kKey, kCharacter, kButton } kind;
    int code;                            // GLFW's of the key or button, or the character
    int scan = 0, action = 0, mods = 0;  // GLFW's
    double x = 0, y = 0;                 // of the mouse when a button changed
  };
  void tell_strokes();

  GLFWwindow* window_ = nullptr;
  int width_ = 0, height_ = 0;
  float scale_ = 1;
  std::vector<Stroke> strokes_;  // not told yet
  std::array<bool, kButtons> buttons_{};
  std::map<int, int> pressed_with_;  // GLFW's modifiers, by key
  bool stirred_ = true;
  std::vector<KeyPress> keys_;
  std::vector<std::string> dropped_;
};

}  // namespace weft::viewer
