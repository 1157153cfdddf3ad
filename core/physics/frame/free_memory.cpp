// What the process may still take (weft/estimate.h), from what Linux tells.
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

#include "weft/estimate.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

// The number after a word at the beginning of a line.
std::optional<double> after(const fs::path& file, const std::string& word) {
  std::ifstream lines(file);
  std::string first;
  double value = 0;
  for (std::string line; lines >> first; std::getline(lines, line))
    if (first == word && lines >> value) return value;
  return std::nullopt;
}

std::optional<double> number_in(const fs::path& file) {
  std::ifstream stream(file);
  double value = 0;
  if (stream >> value) return value;
  return std::nullopt;  // "max", or no such file
}

double free_of_system() {
  constexpr double kKilobyte = 1024;
  const auto available = after("/proc/meminfo", "MemAvailable:");
  if (!available) return kUnknown;
  return kKilobyte * (*available + after("/proc/meminfo", "SwapFree:").value_or(0));
}

// Files that the group has read count as used, but give way.
double free_of_group(const fs::path& group, const char* most, const char* used, const char* files) {
  const auto limit = number_in(group / most), now = number_in(group / used);
  if (!limit || !now) return kUnknown;
  return std::max(0.0, *limit - *now + after(group / "memory.stat", files).value_or(0));
}

// Every group that the process is in limits it, and so do those around it.
double free_of_groups() {
  double least = kUnknown;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string kind = line.substr(first + 1, second - first - 1);
    if (kind != "" && kind != "memory") continue;
    const bool unified = kind.empty();
    const fs::path root = unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    for (fs::path below = fs::path(line.substr(second + 1)).relative_path();;
         below = below.parent_path()) {
      const fs::path group = root / below;
      least = std::min(
          least, unified ? free_of_group(group, "memory.max", "memory.current", "inactive_file")
                         : free_of_group(group, "memory.limit_in_bytes", "memory.usage_in_bytes",
                                         "total_inactive_file"));
      if (below.empty()) break;
    }
  }
  return least;
}

double free_of_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
  const double taken = 1024 * after("/proc/self/status", "VmSize:").value_or(0);
  return std::max(0.0, double(limit.rlim_cur) - taken);
}

}  // namespace

double free_memory() {
  return std::min({free_of_system(), free_of_groups(), free_of_limit()});
}

}  // namespace weft
