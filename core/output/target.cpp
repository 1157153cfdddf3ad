// Links, followed one by one, because the last may lead to a file that is not there yet.
#include "output/target.h"

#include <charconv>
#include <filesystem>

#include "weft/output.h"

namespace weft {

namespace fs = std::filesystem;

namespace {

constexpr int kMostLinks = 40;  // as Linux

// The number of a descriptor of this process that a path below /proc stands for, or -1.
int descriptor_of(const fs::path& folder, const std::string& name) {
  std::error_code error;
  if (folder != fs::canonical("/proc/self/fd", error)) return -1;
  int number = -1;
  const auto [stop, fault] = std::from_chars(name.data(), name.data() + name.size(), number);
  return fault == std::errc() && stop == name.data() + name.size() ? number : -1;
}

}  // namespace

Target find_target(const std::string& path) {
  const auto fail = [&](const std::error_code& error) {
    throw WriteError(path, "cannot write: " + error.message());
  };
  std::error_code error;
  fs::path at = fs::absolute(path, error);
  if (error) fail(error);
  for (int links = 0; links < kMostLinks; ++links) {
    const fs::path folder = fs::canonical(at.parent_path(), error);
    if (error) fail(error);
    at = folder / at.filename();
    Target target{at.string(), folder.string(), false, {}, -1};
    target.descriptor = descriptor_of(folder, at.filename().string());
    if (target.descriptor >= 0) {
      target.exists = ::fstat(target.descriptor, &target.status) == 0;
      return target;
    }
    target.exists = ::lstat(at.c_str(), &target.status) == 0;
    if (!target.exists || !S_ISLNK(target.status.st_mode)) return target;
    at = folder / fs::read_symlink(at, error);
    if (error) fail(error);
  }
  fail(std::make_error_code(std::errc::too_many_symbolic_link_levels));
  return {};
}

}  // namespace weft
