// Tells what the window shows as lines of JSON, one for every change: for tests, and for whoever
// drives the window by a script.
#pragma once

#include <fstream>
#include <string>

#include "hands/hands.h"
#include "panel/theme.h"
#include "window/view.h"
#include "window/workspace.h"

namespace weft::viewer {

class Log {
 public:
  // "" tells nothing. Throws Failure when the file cannot be written.
  explicit Log(const std::string& path);
  void write(const Workspace& workspace, const View& view, const Hands& hands, bool help,
             const Landmarks& controls);
  bool on() const { return file_.is_open(); }

 private:
  std::ofstream file_;
  std::string last_;
};

}  // namespace weft::viewer
