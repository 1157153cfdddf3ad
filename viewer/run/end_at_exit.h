// A session that ends in order, whoever ends the program: a library that finds the display gone calls
// exit(), which destroys nothing that main() holds.
#pragma once

#include "run/session.h"

namespace weft::viewer {

class EndAtExit {
 public:
  explicit EndAtExit(Session& session);
  ~EndAtExit();
  EndAtExit(const EndAtExit&) = delete;
  EndAtExit& operator=(const EndAtExit&) = delete;
};

}  // namespace weft::viewer
