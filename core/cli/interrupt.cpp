// A signal handler that notes the signal, nothing more.
#include "interrupt.h"

#include <csignal>

namespace weft::cli {

namespace {

volatile std::sig_atomic_t caught = 0;

void note(int signal) {
  caught = signal;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
  // A file that meets its size limit is a write that fails, not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
}

int interrupted() {
  return caught;
}

}  // namespace weft::cli
