// Called by exit().
#include "run/end_at_exit.h"

#include <cstdio>
#include <cstdlib>

#include "failure.h"

namespace weft::viewer {

namespace {

Session* last = nullptr;

void end_last() {
  if (last == nullptr) return;
  const std::string problem = last->end();
  std::fputs("weft-viewer: error: the display is gone\n", stderr);
  if (!problem.empty()) std::fprintf(stderr, "weft-viewer: error: %s\n", problem.c_str());
  std::_Exit(kNoGraphics);
}

}  // namespace

EndAtExit::EndAtExit(Session& session) {
  last = &session;
  std::atexit(end_last);
}

EndAtExit::~EndAtExit() {
  last = nullptr;
}

}  // namespace weft::viewer
