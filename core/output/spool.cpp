// Samples kept on disk (spool.h).
#include "output/spool.h"

#include <algorithm>
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

void Spool::copy_to(OutputFile& file, std::int64_t from, std::int64_t bytes) {
  std::array<char, 1 << 16> block{};
  const bool there = ::fseeko(file_.get(), from, SEEK_SET) == 0;
  for (std::int64_t left = bytes; left > 0;) {
    const auto most = std::min<std::int64_t>(left, std::int64_t(block.size()));
    const std::size_t got = std::fread(block.data(), 1, std::size_t(most), file_.get());
    if (!there || got == 0) throw WriteError(path_, "the temporary file cannot be read back");
    file.write({block.data(), got});
    left -= static_cast<std::int64_t>(got);
  }
}

}  // namespace weft
