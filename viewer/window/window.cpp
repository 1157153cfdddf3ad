// GLFW and Dear ImGui's two backends.
#include "window/window.h"

#include <glad/gl.h>
// After the loader's header.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <set>
#include <utility>

#include "failure.h"

namespace weft::viewer {

namespace {

std::string reason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? std::string(": ") + text : "";
}

bool is_modifier(int key) {
  return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
}

Window* window_of(GLFWwindow* window) {
  return static_cast<Window*>(glfwGetWindowUserPointer(window));
}

}  // namespace

Window::Window(int width, int height, const std::string& title) {
  if (glfwInit() == GLFW_FALSE)
    throw Failure(kNoGraphics, "no display can be opened" + reason() +
                                   " (--headless renders pictures without one)");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string why = reason();
    glfwTerminate();
    throw Failure(kNoGraphics, "OpenGL 3.3 is needed for a window, and there is none here" + why);
  }
  glfwSetWindowSizeLimits(window_, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwMakeContextCurrent(window_);
  if (gladLoadGL(glfwGetProcAddress) == 0)
    throw Failure(kNoGraphics, "OpenGL 3.3 is needed, and its functions cannot be loaded");
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scan, int action, int mods) {
    window_of(w)->strokes_.push_back({Stroke::kKey, key, scan, action, mods});
    if (action == GLFW_PRESS) window_of(w)->pressed_with_[key] = mods;
  });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned character) {
    window_of(w)->strokes_.push_back({Stroke::kCharacter, static_cast<int>(character)});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int mods) {
    Stroke stroke{Stroke::kButton, button, 0, action, mods};
    glfwGetCursorPos(w, &stroke.x, &stroke.y);
    window_of(w)->strokes_.push_back(stroke);
  });
  glfwSetWindowFocusCallback(window_, ImGui_ImplGlfw_WindowFocusCallback);
  glfwSetCursorEnterCallback(window_, ImGui_ImplGlfw_CursorEnterCallback);
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
    window_of(w)->stirred_ = true;
    ImGui_ImplGlfw_ScrollCallback(w, x, y);
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double, double) {  // asked for by the panel
    window_of(w)->stirred_ = true;
  });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { window_of(w)->stirred_ = true; });
  glfwSetMonitorCallback(ImGui_ImplGlfw_MonitorCallback);
  glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
    for (int k = 0; k < count; ++k) window_of(w)->dropped_.emplace_back(paths[k]);
  });
  float scale_y = 1;
  glfwGetWindowContentScale(window_, &scale_, &scale_y);
  scale_ = std::clamp(scale_, 1.0f, 4.0f);
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().ConfigDragClickToInputText = true;  // numbers are typed after a click
  ImGui_ImplGlfw_InitForOpenGL(window_, false);
  ImGui_ImplOpenGL3_Init("#version 330 core");
  glfwGetFramebufferSize(window_, &width_, &height_);
}

Window::~Window() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::poll(double seconds) {
  if (seconds > 0 && strokes_.empty())
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
  glfwGetFramebufferSize(window_, &width_, &height_);
}

bool Window::closing() const {
  return glfwWindowShouldClose(window_) == GLFW_TRUE;
}
void Window::close() {
  glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::hide() {
  glfwHideWindow(window_);
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(window_, title.c_str());
}
bool Window::key_down(int key, int mods) const {
  constexpr int kMatter = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
  const auto pressed = pressed_with_.find(key);
  return glfwGetKey(window_, key) == GLFW_PRESS && pressed != pressed_with_.end() &&
         (pressed->second & kMatter) == (mods & kMatter);
}

bool Window::take_stir() {
  return std::exchange(stirred_, false) || !strokes_.empty() || !dropped_.empty();
}

std::vector<KeyPress> Window::take_keys() {
  return std::exchange(keys_, {});
}
std::vector<std::string> Window::take_dropped() {
  return std::exchange(dropped_, {});
}

// The panel sees the state of keys and buttons once a turn. A key that goes down and up between two
// turns would never be down for it, a shortcut would lose its Ctrl, and a key after a click would
// come before the click counts: after a key that goes down, beside Shift, Ctrl and the like, and
// after a button, the next strokes wait for the next turn.
void Window::tell_strokes() {
  std::set<int> told;
  std::size_t k = 0;
  for (bool last = false; k < strokes_.size(); ++k) {
    const Stroke& s = strokes_[k];
    if (s.kind == Stroke::kCharacter) {
      ImGui_ImplGlfw_CharCallback(window_, static_cast<unsigned>(s.code));
      continue;
    }
    if (last) break;
    if (s.kind == Stroke::kButton) {
      if (s.code < kButtons) buttons_[static_cast<std::size_t>(s.code)] = s.action == GLFW_PRESS;
      ImGui::GetIO().MousePos = {static_cast<float>(s.x), static_cast<float>(s.y)};
      last = true;
    } else {
      if (!told.insert(s.code).second && s.action != GLFW_REPEAT) break;
      ImGui_ImplGlfw_KeyCallback(window_, s.code, s.scan, s.action, s.mods);
      if (s.action != GLFW_RELEASE) keys_.push_back({s.code, s.mods, s.action == GLFW_REPEAT});
      last = s.action == GLFW_PRESS && !is_modifier(s.code);
    }
  }
  strokes_.erase(strokes_.begin(), strokes_.begin() + static_cast<std::ptrdiff_t>(k));
}

void Window::begin_panel() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();  // the mouse as it is now
  tell_strokes();             // and as it was when a button changed
  std::copy(buttons_.begin(), buttons_.end(), ImGui::GetIO().MouseDown);
  ImGui::NewFrame();
}

// Clearing costs less than a rectangle of the panel's.
void Window::end_panel(int side) {
  ImGui::Render();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width_, height_);
  if (side > 0) {
    const ImVec4 color = ImGui::GetStyle().Colors[ImGuiCol_WindowBg];
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, side, height_);
    glClearColor(color.x, color.y, color.z, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
  }
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::swap() {
  glfwSwapBuffers(window_);
}

}  // namespace weft::viewer
