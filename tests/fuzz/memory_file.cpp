#include <sys/mman.h>
#include <unistd.h>

#include "target.h"

namespace fuzz {

MemoryFile::MemoryFile(std::string_view bytes) : file_(memfd_create("fuzz", MFD_CLOEXEC)) {
  require(file_ >= 0 && write(file_, bytes.data(), bytes.size()) == ssize_t(bytes.size()));
}

MemoryFile::~MemoryFile() {
  close(file_);
}

std::string MemoryFile::path() const {
  return "/proc/self/fd/" + std::to_string(file_);
}

}  // namespace fuzz
