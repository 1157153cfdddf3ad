// A signal handler that notes the signal, nothing more.
#include "interrupt.h"

#include <unistd.h>

#include <csignal>
#include <ctime>

namespace weft::cli {

namespace {

volatile std::sig_atomic_t caught = 0;
volatile std::time_t caught_at = 0;

// The same signal may arrive twice at once (to the process and to its group): only one that comes
// later is a person's second thought.
void note(int signal) {
  const std::time_t now = std::time(nullptr);
  if (caught != 0 && now - caught_at > 1) ::_exit(128 + signal);
  if (caught == 0) caught_at = now;
  caught = signal;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART;
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
