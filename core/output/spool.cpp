// Samples kept on disk (spool.h).
#include "output/spool.h"

#include <array>
#include <cerrno>
#include <cstring>

namespace weft {

Spool::Spool(std::string path) : path_(std::move(path)), file_(std::tmpfile()) {
  if (!file_) throw WriteError(path_, std::string("no temporary file: ") + std::strerror(errno));
}

void Spool::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    throw WriteError(path_, std::string("the temporary file is full: ") + std::strerror(errno));
  bytes_ += static_cast<std::int64_t>(bytes.size());
}

void Spool::copy_to(OutputFile& file) {
  std::rewind(file_.get());
  std::array<char, 1 << 16> block{};
  for (std::int64_t left = bytes_; left > 0;) {
    const std::size_t got = std::fread(block.data(), 1, block.size(), file_.get());
    if (got == 0) throw WriteError(path_, "the temporary file cannot be read back");
    file.write({block.data(), got});
    left -= static_cast<std::int64_t>(got);
  }
}

}  // namespace weft
