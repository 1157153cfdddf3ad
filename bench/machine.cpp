// Reads what the system tells about the machine (machine.h).
#include "machine.h"

#include <fstream>
#include <thread>

namespace bench {
namespace {

// The value of the first line of a file that begins with `key`, quotes and separators removed.
std::string value_in(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t from = line.find_first_not_of(" \t:=\"", key.size());
    const std::size_t to = line.find_last_not_of(" \t\"");
    return from == std::string::npos ? "" : line.substr(from, to - from + 1);
  }
  return "";
}

#define WEFT_TEXT_(v) #v  // after expansion
#define WEFT_TEXT(v) WEFT_TEXT_(v)
#if defined(__clang__)
constexpr const char* kCompiler = "clang++ " __clang_version__;
#else
constexpr const char* kCompiler =
    "g++ " WEFT_TEXT(__GNUC__) "." WEFT_TEXT(__GNUC_MINOR__) "." WEFT_TEXT(__GNUC_PATCHLEVEL__);
#endif

std::string cpu_name() {
  const char* info = "/proc/cpuinfo";
  std::string name = value_in(info, "model name");
  if (name.empty()) return "unknown processor";
  return name + " (family " + value_in(info, "cpu family") + ", model " +
         value_in(info, "model\t") + ")";
}

}  // namespace

const Machine& machine() {
  static const Machine m{cpu_name(), int(std::thread::hardware_concurrency()), kCompiler,
                         value_in("/etc/os-release", "PRETTY_NAME")};
  return m;
}

std::string machine_line() {
  const Machine& m = machine();
  return m.cpu + ", " + std::to_string(m.cores) + (m.cores == 1 ? " core, " : " cores, ") +
         m.compiler + ", " + m.system;
}

}  // namespace bench
