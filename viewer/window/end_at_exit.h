// An end in order, whoever ends the program: a library that finds the display gone calls exit(), which
// destroys nothing that main() holds.
#pragma once

#include <functional>
#include <string>

namespace weft::viewer {

class EndAtExit {
 public:
  // What exit() calls while this lives; gives what went wrong, or "".
  explicit EndAtExit(std::function<std::string()> end);
  ~EndAtExit();
  EndAtExit(const EndAtExit&) = delete;
  EndAtExit& operator=(const EndAtExit&) = delete;
};

}  // namespace weft::viewer
