#include "log.h"

#include <cinttypes>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace fuzz {

std::map<std::uint64_t, Entry> read_log(const std::string& path) {
  std::map<std::uint64_t, Entry> entries;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line) && !file.eof();) {
    std::istringstream words(line);
    std::uint64_t seed = 0;
    Entry e;
    if (!(words >> seed >> std::hex >> e.scene >> e.result >> std::dec >> e.ms >> std::ws))
      continue;
    std::getline(words, e.answer);
    entries[seed] = e;
  }
  return entries;
}

Log::Log(const std::string& path) {
  if (path.empty()) return;
  file_ = std::fopen(path.c_str(), "a");
  if (!file_) throw std::runtime_error(path + ": cannot be written");
  std::ifstream before(path, std::ios::binary | std::ios::ate);
  if (before.tellg() <= 0) return;
  before.seekg(-1, std::ios::end);
  if (before.get() != '\n') std::fputc('\n', file_);  // half a line of a run that was cut off
}

Log::~Log() {
  if (file_) std::fclose(file_);
}

void Log::add(std::uint64_t seed, const Entry& e) {
  if (!file_) return;
  std::fprintf(file_, "%" PRIu64 " %016" PRIx64 " %016" PRIx64 " %.0f %s\n", seed, e.scene,
               e.result, e.ms, e.answer.c_str());
  std::fflush(file_);
}

}  // namespace fuzz
