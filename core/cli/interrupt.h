// Ctrl-C and termination, as a question that a loop can ask.
#pragma once

namespace weft::cli {

// From now on the first SIGINT, SIGTERM or SIGHUP only makes interrupted() answer; one that comes
// a second or more later ends the process at once.
void catch_interrupts();

// The signal that came, or 0.
int interrupted();

}  // namespace weft::cli
