// Signal handlers, which can do little more than set flags.
#include "weft/interrupt.h"

#include <semaphore.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>

#include "weft/output.h"

namespace weft {

namespace {

std::atomic<int> caught = 0;  // a signal that asks for the end
std::atomic<int> ending = 0;  // one that ends the process now, or after `holds`
std::atomic<int> holds = 0;   // Uninterrupted
std::atomic<std::time_t> caught_at = 0;
sem_t waiting;

void end_process(int signal) {
  remove_temporaries();
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  ::sigaction(signal, &action, nullptr);
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, signal);
  ::raise(signal);
  ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

void end_soon(int signal) {
  ending = signal;
  if (holds == 0) end_process(signal);
}

// The same signal may arrive twice at once (to the process and to its group): only one that comes
// later is a person's second thought. SIGXCPU comes every second by itself.
void note(int signal) {
  const std::time_t now = std::time(nullptr);
  if (caught != 0) {
    if (signal != SIGXCPU && now - caught_at > 1) end_soon(signal);
    return;
  }
  caught_at = now;
  caught = signal;
  ::sem_post(&waiting);
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  ::sigaction(signal, nullptr, &action);
  if (action.sa_handler == SIG_IGN) return;
  action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

void catch_interrupts() {
  ::sem_init(&waiting, 0, 0);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) handle(signal, note);
  for (const int signal : {SIGQUIT, SIGPIPE}) handle(signal, end_soon);
  std::signal(SIGXFSZ, SIG_IGN);
}

int interrupted() {
  return caught;
}

void wait_for_interrupt() {
  while (::sem_wait(&waiting) != 0) {  // a signal handler ran on this thread
  }
}

void wake_waiting() {
  ::sem_post(&waiting);
}

Uninterrupted::Uninterrupted() {
  ++holds;
}

Uninterrupted::~Uninterrupted() {
  if (--holds == 0 && ending != 0) end_process(ending);
}

}  // namespace weft
