// The program with its window: one turn of the loop after another.
#pragma once

#include "command_line.h"
#include "hands/hands.h"
#include "panel/panel.h"
#include "window/end_at_exit.h"
#include "window/figures.h"
#include "window/filming.h"
#include "window/keys.h"
#include "window/log.h"
#include "window/view.h"
#include "window/window.h"
#include "window/workspace.h"

namespace weft::viewer {

class App {
 public:
  // Throws Failure.
  explicit App(const Arguments& arguments);

  // Until the window closes.
  void run();

 private:
  void read_keys(const std::string& path);
  void dispatch(Action action);
  void close_top();
  void dispatch_scene(Action action);
  void dispatch_view(Action action);
  void dispatch_part(Action action);
  void push_bodies(double seconds);
  void take_dropped();
  bool measured(double begun);
  bool due(double now, bool fresh);
  void turn();
  void draw_picture();
  void apply(const Requests& requests);
  void take_picture(const PictureRequest& asked);
  void start_or_end_film(const FilmRequest& asked);
  std::string end();
  std::pair<int, int> picture_size() const;  // pixels

  Window window_;
  Keys keys_;
  Workspace workspace_;
  View view_;
  Hands hands_;
  Panel panel_;
  Log log_;
  Landmarks landmarks_;
  Filming filming_;
  double measure_;  // s, 0: not at all
  std::vector<Turn> turns_;
  Turn turn_;             // the present one
  double last_turn_ = 0;  // s, of those that drew
  double stirred_ = 0;    // s, when somebody did something
  double paused_at_ = 0;  // s, at the end of a measurement
  double worked_ms_ = 0;  // of all threads, until then
  EndAtExit end_at_exit_{[this] { return end(); }};
};

}  // namespace weft::viewer
