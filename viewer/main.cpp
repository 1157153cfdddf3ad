// The program weft-viewer: a window, or one picture without any display.
#include <csignal>
#include <cstdio>
#include <exception>

#include "command_line.h"
#include "failure.h"
#include "headless.h"
#include "weft/interrupt.h"
#include "weft/standard_streams.h"
#include "window/app.h"

namespace weft::viewer {

namespace {

int run(int count, char** words) {
  Arguments arguments;
  if (const auto code = parse_arguments(count, words, arguments)) return *code;
  if (arguments.headless)
    render_picture(arguments);
  else
    App(arguments).run();
  return interrupted() == 0 ? kDone : 128 + interrupted();
}

}  // namespace

}  // namespace weft::viewer

int main(int count, char** words) {
  weft::occupy_standard_streams();
  weft::catch_interrupts();
  std::signal(SIGPIPE, SIG_IGN);  // a display or an ffmpeg that is gone is told by write()
  try {
    return weft::viewer::run(count, words);
  } catch (const weft::viewer::Failure& failure) {
    std::fprintf(stderr, "weft-viewer: error: %s\n", failure.what());
    return failure.code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weft-viewer: error: internal: %s\n", error.what());
    return weft::viewer::kStopped;
  }
}
