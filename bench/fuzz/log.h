// The log of many scenes: a line each, "SEED SCENE RESULT MILLISECONDS ANSWER", hashes as 16
// hexadecimal digits. Logs of other builds are compared with it, and runs go on where it ends.
#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <string>

namespace fuzz {

struct Entry {
  std::uint64_t scene = 0, result = 0;  // hashes
  double ms = 0;
  std::string answer;  // "ok" or the failure
  bool ok() const { return answer == "ok"; }
};

// By seed. Half a line at the end is left out. An absent file is an empty log.
std::map<std::uint64_t, Entry> read_log(const std::string& path);

class Log {
 public:
  // Goes on with the file; "" writes none. Throws std::runtime_error.
  explicit Log(const std::string& path);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
  void add(std::uint64_t seed, const Entry& entry);

 private:
  std::FILE* file_ = nullptr;
};

}  // namespace fuzz
