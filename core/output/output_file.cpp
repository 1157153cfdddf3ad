// OutputFile: a temporary file in the target's folder that takes the target's name on commit.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

#include "output/staging.h"
#include "output/target.h"
#include "weft/output.h"

namespace weft {

WriteError::WriteError(std::string file, const std::string& why)
    : std::runtime_error(why), path(std::move(file)) {}

struct OutputFile::Stream {
  std::FILE* file = nullptr;
  Target target;
  std::shared_ptr<Staging> staging;  // none: written directly
  std::string temporary;             // in it

  ~Stream() {
    if (file != nullptr) std::fclose(file);
  }
};

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what, int why = errno) {
  throw WriteError(path, what + ": " + std::generic_category().message(why));
}

// A new file has the mode that the umask leaves; one that replaces another has that one's, and its
// owner as far as this process may give it away.
int open_temporary(const std::string& path, const Target& target) {
  const int file =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, target.exists ? 0600 : 0666);
  if (file < 0 || !target.exists) return file;
  const auto& old = target.status;
  if (::fchown(file, old.st_uid, old.st_gid) != 0 && ::fchown(file, uid_t(-1), old.st_gid) != 0)
    errno = 0;  // its own then
  if (::fchmod(file, old.st_mode & 07777U) == 0) return file;
  const int why = errno;
  ::close(file);
  errno = why;
  return -1;
}

}  // namespace

OutputFile::OutputFile(std::string path) : OutputFile(std::move(path), nullptr) {}
OutputFile::OutputFile(std::string path, const OutputFile& beside)
    : OutputFile(std::move(path), &beside) {}

OutputFile::OutputFile(std::string path, const OutputFile* beside)
    : path_(std::move(path)), stream_(std::make_unique<Stream>()) {
  if (path_.empty()) throw WriteError(path_, "a file name is needed");
  Target& target = stream_->target = find_target(path_);
  if (target.exists && S_ISDIR(target.status.st_mode))
    throw WriteError(path_, "cannot write: it is a directory");
  if (target.exists && target.descriptor < 0 && ::access(target.path.c_str(), W_OK) != 0)
    fail(path_, "cannot write");
  int file = -1;
  if (target.descriptor >= 0) {
    file = ::fcntl(target.descriptor, F_DUPFD_CLOEXEC, 0);
  } else if (!target.replaceable()) {
    file = ::open(target.path.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    open_staging(beside);
    file = open_temporary(stream_->temporary, target);
  }
  if (file < 0) fail(path_, "cannot write");
  stream_->file = ::fdopen(file, "wb");
  if (stream_->file == nullptr) fail(path_, "cannot write");
}

void OutputFile::open_staging(const OutputFile* beside) {
  const std::string& folder = stream_->target.folder;
  if (beside != nullptr && beside->stream_->staging && beside->stream_->staging->folder() == folder)
    stream_->staging = beside->stream_->staging;
  try {
    if (!stream_->staging) stream_->staging = std::make_shared<Staging>(folder);
  } catch (const std::system_error& error) {
    fail(path_, "cannot write", error.code().value());
  }
  stream_->temporary = stream_->staging->next();
}

OutputFile::~OutputFile() = default;
OutputFile::OutputFile(OutputFile&& other) noexcept = default;

std::string OutputFile::temporary() const {
  return stream_->staging ? stream_->temporary : path_;
}

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

void OutputFile::complete(bool store) {
  if (stream_->file == nullptr) return;
  // Closing flushes the last buffer: only a successful close means that all of it arrived.
  const bool stored = std::fflush(stream_->file) == 0 &&
                      (!store || !stream_->staging || ::fsync(::fileno(stream_->file)) == 0);
  const int why = errno;
  const bool closed = std::fclose(std::exchange(stream_->file, nullptr)) == 0;
  if (!stored) fail(path_, "writing failed", why);
  if (!closed) fail(path_, "writing failed");
}

void OutputFile::commit() {
  complete();
  if (!stream_->staging) return;
  if (std::rename(stream_->temporary.c_str(), stream_->target.path.c_str()) != 0)
    fail(path_, "cannot take its name");
  stream_->staging.reset();
}

}  // namespace weft
