// Staging folders: .weft-PID-RANDOM.tmp with the files 0, 1, 2, … and `lock`.
#include "output/staging.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstring>
#include <filesystem>
#include <random>
#include <string_view>
#include <system_error>

#include "output/hex.h"
#include "weft/output.h"

namespace weft {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPrefix = ".weft-", kSuffix = ".tmp";
constexpr std::size_t kLongestPath = PATH_MAX - 16;  // room for the names of its files

// What a signal handler needs to remove a staging folder: it can neither allocate nor lock.
struct Slot {
  std::atomic<bool> taken = false;
  std::atomic<bool> known = false;  // path is whole
  std::atomic<unsigned> files = 0;
  std::array<char, PATH_MAX> path{};
};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<unsigned>::is_always_lock_free);
constinit std::array<Slot, 64> slots{};

// A free slot, or -1: then the folder is removed by its owner alone.
int take_slot() {
  for (std::size_t n = 0; n < slots.size(); ++n)
    if (!slots[n].taken.exchange(true)) return static_cast<int>(n);
  return -1;
}

// Safe in a signal handler.
void remove_files(const char* folder, unsigned files) {
  std::array<char, PATH_MAX> path{};
  const std::size_t size = std::strlen(folder);
  std::memcpy(path.data(), folder, size);
  char* const name = path.data() + size + 1;
  name[-1] = '/';
  for (unsigned n = 0; n < files; ++n) {
    *std::to_chars(name, path.data() + path.size() - 1, n).ptr = '\0';
    ::unlink(path.data());
  }
  std::memcpy(name, "lock", 5);
  ::unlink(path.data());
  ::rmdir(folder);
}

bool is_number(std::string_view name) {
  return !name.empty() && name.find_first_not_of("0123456789") == std::string_view::npos;
}

// Removes a staging folder whose owner is gone. Where nothing can be locked, none is known to be.
void remove_abandoned(const fs::path& path) {
  struct stat status {};  // never what another person has put in the way
  if (::lstat(path.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) ||
      status.st_uid != ::geteuid())
    return;
  const int lock = ::open((path / "lock").c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (lock < 0) {
    if (errno == ENOENT) ::rmdir(path.c_str());  // the lock goes last: it is empty, or not ours
    return;
  }
  if (::flock(lock, LOCK_EX | LOCK_NB) == 0) {
    std::error_code error;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end;
         entry.increment(error))
      if (is_number(entry->path().filename().string())) ::unlink(entry->path().c_str());
    ::unlink((path / "lock").c_str());
    ::rmdir(path.c_str());
  }
  ::close(lock);
}

void remove_all_abandoned(const std::string& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(kPrefix) && name.ends_with(kSuffix)) remove_abandoned(entry->path());
  }
}

[[noreturn]] void fail(int why) {
  throw std::system_error(why, std::generic_category());
}

}  // namespace

void remove_temporaries() noexcept {
  for (Slot& slot : slots)
    if (slot.known) remove_files(slot.path.data(), slot.files);
}

Staging::Staging(std::string folder) : folder_(std::move(folder)) {
  remove_all_abandoned(folder_);
  while (!make()) {
  }
}

// False when another process took it for abandoned before it was locked.
bool Staging::make() {
  std::random_device random;
  const std::uint64_t number = std::uint64_t{random()} << 32 | random();
  path_ = folder_ + "/" + std::string(kPrefix) + std::to_string(::getpid()) + "-" + hex16(number) +
          std::string(kSuffix);
  if (path_.size() >= kLongestPath) fail(ENAMETOOLONG);
  slot_ = take_slot();
  if (slot_ >= 0) {
    Slot& slot = slots[static_cast<std::size_t>(slot_)];
    std::memcpy(slot.path.data(), path_.c_str(), path_.size() + 1);
    slot.files = 0;
    slot.known = true;
  }
  if (::mkdir(path_.c_str(), 0700) != 0) {
    const int why = errno;
    release_slot();
    fail(why);
  }
  lock_ = ::open((path_ + "/lock").c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (lock_ < 0 && errno != ENOENT) {
    const int why = errno;
    remove();
    fail(why);
  }
  struct stat status {};
  const bool lost = lock_ < 0 || (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) ||
                    (::fstat(lock_, &status) == 0 && status.st_nlink == 0);
  if (lost) remove();
  return !lost;
}

void Staging::remove() {
  remove_files(path_.c_str(), files_);
  if (lock_ >= 0) ::close(lock_);
  lock_ = -1;
  release_slot();
}

void Staging::release_slot() {
  if (slot_ < 0) return;
  slots[static_cast<std::size_t>(slot_)].known = false;
  slots[static_cast<std::size_t>(slot_)].taken = false;
  slot_ = -1;
}

Staging::~Staging() {
  remove();
}

std::string Staging::next() {
  const unsigned number = files_++;
  if (slot_ >= 0) slots[static_cast<std::size_t>(slot_)].files = files_;
  return path_ + "/" + std::to_string(number);
}

}  // namespace weft
