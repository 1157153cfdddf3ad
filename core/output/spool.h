// Samples kept on disk until all that comes before them in a file is known.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "weft/output.h"

namespace weft {

class Spool {
 public:
  // Opens an unnamed temporary file; `path` is named when something fails (WriteError).
  explicit Spool(std::string path);
  void write(std::string_view bytes);
  std::int64_t bytes() const { return bytes_; }
  // Appends all that was written to the file, or so many bytes of it from a place on.
  void copy_to(OutputFile& file) { copy_to(file, 0, bytes_); }
  void copy_to(OutputFile& file, std::int64_t from, std::int64_t bytes);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::int64_t bytes_ = 0;
};

}  // namespace weft
