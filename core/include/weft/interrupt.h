// Signals that end a program, as a question that a loop can ask, and no temporary file left by any.
#pragma once

#include <ctime>

namespace weft {

// From now on the first SIGINT, SIGTERM, SIGHUP or SIGXCPU makes interrupted() answer, and a second
// one that comes a second or more later ends the process at once, as SIGQUIT and SIGPIPE do: without
// temporary files (weft/output.h), by the signal's default action. What the process was started to
// ignore (nohup) it ignores. SIGXFSZ is a write that fails.
void catch_interrupts();

// The signal that came, or 0.
int interrupted();

// Waits for a signal, or for wake_waiting().
void wait_for_interrupt();
void wake_waiting();

// While one lives no signal ends the process: several files take their names. One that came ends it
// afterwards.
class Uninterrupted {
 public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
};

}  // namespace weft
