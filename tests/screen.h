// A screen of a test's own (Xvfb) with the viewer's window on it, driven by real mouse and key events
// (xdotool) and looked at through its log and by pictures of the screen (ffmpeg).
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "folder.h"

namespace weft {

inline bool has_screen_tools() {
  return std::system(
             "command -v Xvfb >/dev/null && command -v xdotool >/dev/null && "
             "command -v ffmpeg >/dev/null") == 0;
}

constexpr int kScreenWidth = 1280, kScreenHeight = 800;

// Mean difference of two pictures beside the panel, 0 … 255.
inline double difference(const std::string& a, const std::string& b) {
  if (a.size() != b.size() || a.empty()) return 255;
  double sum = 0, count = 0;
  for (int y = 100; y < kScreenHeight - 80; ++y)
    for (int x = 3 * 360; x < 3 * kScreenWidth; ++x) {
      const auto at = static_cast<std::size_t>(3 * kScreenWidth * y + x);
      sum += std::abs(static_cast<unsigned char>(a[at]) - static_cast<unsigned char>(b[at]));
      ++count;
    }
  return sum / count;
}

class Screen {
 public:
  static constexpr int kWidth = kScreenWidth, kHeight = kScreenHeight;

  explicit Screen(const Folder& folder, int width = kWidth, int height = kHeight)
      : folder_(folder), size_(std::to_string(width) + "x" + std::to_string(height)) {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    server_ = spawn("exec Xvfb -displayfd " + std::to_string(ends[1]) + " -screen 0 " + size_ +
                    "x24 -nolisten tcp 2>/dev/null");
    ::close(ends[1]);
    char number[16] = {};
    EXPECT_GT(::read(ends[0], number, sizeof number - 1), 0);
    ::close(ends[0]);
    display_ = ":" + std::to_string(std::atoi(number));
  }
  ~Screen() {
    close();
    end_server();
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  // Starts the viewer in the test's folder, or one in it, and waits for its first picture.
  void open(const std::string& words, const std::string& before = "",
            const std::string& inside = ".") {
    std::remove((folder_ / "log").c_str());
    viewer_ = spawn("cd '" + (folder_ / inside) + "' && DISPLAY=" + display_ + " HOME='" +
                    folder_.path() + "' XDG_CONFIG_HOME= XDG_STATE_HOME='" + folder_.path() + "' " +
                    before + " exec '" WEFT_VIEWER_PROGRAM "' " + words + " --size " + size_ +
                    " --log '" + (folder_ / "log") + "' >'" + (folder_ / "out") + "' 2>'" +
                    (folder_ / "err") + "'");
    wait("the window", [](const nlohmann::json& now) { return now.contains("frame"); });
  }

  // The newest whole line of the log.
  nlohmann::json now() const {
    std::ifstream file(folder_ / "log");
    std::string line, last;
    while (std::getline(file, line))
      if (!file.eof()) last = line;
    return last.empty() ? nlohmann::json::object() : nlohmann::json::parse(last);
  }

  // Until the window is as expected; the test fails when that never comes.
  using Condition = std::function<bool(const nlohmann::json&)>;
  nlohmann::json wait(const std::string& what, const Condition& condition) const {
    bool there = true;
    for (int k = 0; k < 2400 && there; ++k) {
      there = runs();  // what it wrote last counts
      const nlohmann::json state = now();
      if (!state.empty() && condition(state)) return state;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ADD_FAILURE() << (there ? "never came: " : "the viewer ended before: ") << what
                  << "\nlast: " << now().dump() << "\n"
                  << said();
    return now();
  }
  nlohmann::json wait_for(const std::string& key, const nlohmann::json& value) const {
    return wait(key + " = " + value.dump(),
                [&](const nlohmann::json& state) { return state.at(key) == value; });
  }

  // Words of xdotool.
  void type(const std::string& words) const {
    EXPECT_EQ(std::system(("DISPLAY=" + display_ + " xdotool " + words).c_str()), 0) << words;
  }
  void key(const std::string& name) const { type("key " + name); }
  // Steps a paused scene on, one frame after the other.
  void step_to(int frame) const {
    for (int k = now().at("frame"); k < frame; ++k) {
      key("n");
      wait_for("frame", k + 1);
    }
  }
  void click(int x, int y) const {
    type("mousemove " + std::to_string(x) + " " + std::to_string(y) + " sleep 0.4 click 1");
  }
  // A control of the panel by its name in the log. What appears above it moves it: the pointer follows.
  void click(const std::string& control) const {
    nlohmann::json at = place(control);
    for (nlohmann::json before; at != before; at = place(control)) {
      type("mousemove " + at[0].dump() + " " + at[1].dump() + " sleep 0.4");
      before = at;
    }
    type("click 1");
  }
  // Into a control of a number, by Ctrl + click.
  void type_number(const std::string& control, const std::string& value) const {
    const nlohmann::json at = place(control);
    type("mousemove " + at[0].dump() + " " + at[1].dump() +
         " sleep 0.5 keydown ctrl sleep 0.3 click 1 sleep 0.3 keyup ctrl");
    wait_for("typing", true);
    type("key ctrl+a type -- " + value);
    key("Return");
    wait_for("typing", false);
  }
  // Once the eye stands still.
  nlohmann::json settled() const {
    nlohmann::json before, state = now();
    do {
      before = state;
      std::this_thread::sleep_for(std::chrono::milliseconds(400));
      state = now();
    } while (state["eye"] != before["eye"] && runs());
    return state;
  }
  // Presses at the first point, goes on to the others, and lets go once the window is as expected.
  void drag(const std::vector<std::pair<int, int>>& points, const std::string& what,
            const Condition& condition) const {
    const auto to = [](std::pair<int, int> p) {
      return "mousemove " + std::to_string(p.first) + " " + std::to_string(p.second) + " sleep 0.5";
    };
    type(to(points.front()) + " mousedown 1");
    wait_for("busy", true);
    for (const auto& point : points) type(to(point));
    wait(what, condition);
    type("mouseup 1");
    wait_for("busy", false);
  }

#ifdef WEFT_DROP_PROGRAM
  // Drops files onto the window; paths are relative to the test's folder.
  void drop(const std::string& files) const {
    const std::string command =
        "cd '" + folder_.path() + "' && DISPLAY=" + display_ + " '" WEFT_DROP_PROGRAM "' " + files;
    EXPECT_EQ(std::system(command.c_str()), 0) << files;
  }
#endif

  // The screen as RGB bytes.
  std::string picture() const {
    const std::string file = folder_ / "screen.rgb";
    EXPECT_EQ(
        std::system(("ffmpeg -y -loglevel error -f x11grab -video_size 1280x800 -i " + display_ +
                     " -frames:v 1 -pix_fmt rgb24 -f rawvideo '" + file + "' </dev/null")
                        .c_str()),
        0);
    return folder_.read("screen.rgb");
  }

  // Until a picture of the screen is as expected.
  std::string wait_picture(const std::string& what,
                           const std::function<bool(const std::string&)>& condition) const {
    std::string now;
    for (int k = 0; k < 100; ++k) {
      now = picture();
      if (condition(now)) return now;
    }
    ADD_FAILURE() << "never seen: " << what;
    return now;
  }

  // Off everything, so that no help covers the picture. The window has seen it, and all that was done before.
  void point_aside() const {
    type("mousemove 100 790");
    wait_for("pointer", {100, 790});
  }
  // Until a picture is as expected and in full, and stays for half a second while nothing happens in the window.
  std::string settled_picture(const std::string& what,
                              const std::function<bool(const std::string&)>& condition) const {
    std::string before, now = picture();
    nlohmann::json state_before, state = this->now();
    for (int k = 0; k < 100; ++k) {
      before = now, state_before = state;
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      now = picture(), state = this->now();
      if (condition(now) && state == state_before && !state["coarse"].get<bool>() &&
          difference(now, before) < 1e-3)
        return now;
    }
    ADD_FAILURE() << "never seen at rest: " << what;
    return now;
  }

  // Whether the viewer has not ended; it is left for finish().
  bool runs() const {
    siginfo_t ended{};
    return ::waitid(P_PID, static_cast<id_t>(viewer_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           ended.si_pid == 0;
  }
  // Ends the viewer by its own key; its exit code, 128 + n for signal n.
  int quit() {
    if (viewer_ > 0) key("ctrl+q");
    return finish();
  }
  pid_t viewer() const {
    return viewer_;
  }
  void send(int signal) const {
    EXPECT_EQ(::kill(viewer_, signal), 0);
  }
  // Waits for the viewer to end by itself.
  int finish() {
    int status = 0;
    if (viewer_ <= 0) return -1;
    ::waitpid(viewer_, &status, 0);
    viewer_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  void close() {
    if (viewer_ > 0) ::kill(viewer_, SIGKILL);
    finish();
  }
  void end_server() {
    if (server_ <= 0) return;
    ::kill(server_, SIGTERM);
    ::waitpid(server_, nullptr, 0);
    server_ = 0;
  }
  const std::string& display() const {
    return display_;
  }
  std::string said() const {
    return folder_.has("err") ? folder_.read("err") : "";
  }

 private:
  // Where a control is, once it is there.
  nlohmann::json place(const std::string& control) const {
    return wait("control " + control, [&](const nlohmann::json& now) {
      return now.at("controls").contains(control);
    })["controls"][control];
  }

  static pid_t spawn(const std::string& command) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      ::_exit(127);
    }
    return child;
  }

  const Folder& folder_;
  std::string size_;  // of the screen, WxH
  pid_t server_ = 0, viewer_ = 0;
  std::string display_;
};

// Whether a message in the window has the text.
inline bool tells(const nlohmann::json& now, const std::string& text) {
  return now["news"].dump().find(text) != std::string::npos;
}

// A test with a folder and a screen of its own.
class Window : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_screen_tools()) GTEST_SKIP() << "Xvfb, xdotool and ffmpeg are needed";
  }
  // The exit code of `weft` in the test's folder.
  int weft(const std::string& words, const std::string& out = "weft.out") const {
    return run("'" WEFT_PROGRAM "' " + words + " >" + out + " 2>&1");
  }
  // The exit code of a command line there.
  int run(const std::string& command) const {
    const int status = std::system(("cd '" + folder.path() + "' && " + command).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  Folder folder;
};

}  // namespace weft
