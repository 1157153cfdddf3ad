// The machine that figures are measured on.
#pragma once

#include <string>

namespace bench {

struct Machine {
  std::string cpu;       // "AMD EPYC …"
  int cores = 0;         // that this program may use
  std::string compiler;  // "g++ 12.2.0"
  std::string system;    // "Debian GNU/Linux 12 (bookworm)"
};

const Machine& machine();

// "AMD EPYC, 2 cores, g++ 12.2.0"
std::string machine_line();

}  // namespace bench
