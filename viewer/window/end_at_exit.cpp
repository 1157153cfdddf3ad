// Called by exit().
#include "window/end_at_exit.h"

#include <cstdio>
#include <cstdlib>

#include "failure.h"
#include "weft/output.h"

namespace weft::viewer {

namespace {

std::function<std::string()> end_all;

void end_in_order() {
  if (!end_all) return;
  const std::string problem = end_all();
  remove_temporaries();
  std::fputs("weft-viewer: error: the display is gone\n", stderr);
  if (!problem.empty()) std::fprintf(stderr, "weft-viewer: error: %s\n", problem.c_str());
  std::_Exit(kNoGraphics);
}

}  // namespace

EndAtExit::EndAtExit(std::function<std::string()> end) {
  end_all = std::move(end);
  std::atexit(end_in_order);
}

EndAtExit::~EndAtExit() {
  end_all = nullptr;
}

}  // namespace weft::viewer
