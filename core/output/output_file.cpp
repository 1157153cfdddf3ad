// OutputFile: a temporary file in the target's directory that takes the target's name on commit.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "weft/output.h"

namespace weft {

namespace fs = std::filesystem;

WriteError::WriteError(std::string file, const std::string& why)
    : std::runtime_error(why), path(std::move(file)) {}

struct OutputFile::Stream {
  std::FILE* file = nullptr;
  std::string target;     // the path with links resolved, so that a link is not replaced by a file
  std::string temporary;  // "" when written directly

  ~Stream() {
    if (file != nullptr) std::fclose(file);
    if (!temporary.empty()) ::unlink(temporary.c_str());
  }
};

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw WriteError(path, what + ": " + std::strerror(errno));
}

// A temporary name that no other file of this or another process uses.
std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> count = 0;
  return target + "." + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".tmp";
}

}  // namespace

OutputFile::OutputFile(std::string path)
    : path_(std::move(path)), stream_(std::make_unique<Stream>()) {
  if (path_.empty()) throw WriteError(path_, "a file name is needed");
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (fs::is_directory(status)) throw WriteError(path_, "cannot write: it is a directory");
  const bool exists = fs::exists(status);
  if (exists && ::access(path_.c_str(), W_OK) != 0) fail(path_, "cannot write");
  const fs::path resolved = fs::weakly_canonical(path_, error);
  stream_->target = error ? path_ : resolved.string();

  int flags = O_WRONLY | O_CREAT | O_CLOEXEC;
  std::string opened = path_;
  if (!exists || fs::is_regular_file(status)) {
    stream_->temporary = opened = temporary_name(stream_->target);
    flags |= O_EXCL;
    // Only a process of this number, now gone, can have left it.
    ::unlink(opened.c_str());
  }
  const int descriptor = ::open(opened.c_str(), flags, 0666);
  if (descriptor < 0) {
    stream_->temporary.clear();
    fail(path_, "cannot write");
  }
  stream_->file = ::fdopen(descriptor, "wb");
  if (stream_->file == nullptr) fail(path_, "cannot write");
}

OutputFile::~OutputFile() = default;
OutputFile::OutputFile(OutputFile&& other) noexcept = default;

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_->file) != bytes.size()) {
    fail(path_, "writing failed");
  }
}

void OutputFile::overwrite(std::int64_t offset, std::string_view bytes) {
  if (std::fseek(stream_->file, static_cast<long>(offset), SEEK_SET) != 0) {
    fail(path_, "cannot go back in this kind of file");
  }
  write(bytes);
  if (std::fseek(stream_->file, 0, SEEK_END) != 0) fail(path_, "writing failed");
}

void OutputFile::commit() {
  // Closing flushes the last buffer: only a successful close means that all of it arrived.
  if (std::fclose(std::exchange(stream_->file, nullptr)) != 0) fail(path_, "writing failed");
  if (stream_->temporary.empty()) return;
  if (std::rename(stream_->temporary.c_str(), stream_->target.c_str()) != 0) {
    fail(path_, "cannot take its name");
  }
  stream_->temporary.clear();
}

}  // namespace weft
