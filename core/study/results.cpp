#include "study/results.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "study/jobs.h"
#include "weft/output.h"

namespace weft {

namespace {

constexpr const char* kStays = " (what is finished stays; --resume goes on)";

// Before each payload of the journal.
struct Frame {
  std::uint32_t magic = 0x54464557;  // "WEFT"
  std::uint32_t sum = 0;             // CRC-32 of the payload
  std::uint64_t size = 0;
};

std::uint32_t sum_of(const std::string& bytes) {
  return std::uint32_t(::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw WriteError(path, what + ": " + std::generic_category().message(errno));
}

// All bytes, or false; errno says why.
bool read_all(int file, char* to, std::size_t size, std::uint64_t offset) {
  while (size > 0) {
    const ssize_t got = ::pread(file, to, size, off_t(offset));
    if (got <= 0) return false;
    to += got, size -= std::size_t(got), offset += std::uint64_t(got);
  }
  return true;
}
bool write_all(int file, const char* from, std::size_t size, std::uint64_t offset) {
  while (size > 0) {
    const ssize_t put = ::pwrite(file, from, size, off_t(offset));
    if (put <= 0) return false;
    from += put, size -= std::size_t(put), offset += std::uint64_t(put);
  }
  return true;
}

// Returns when the disk has what the descriptor holds; a file system that cannot tell has no say.
bool reaches_disk(int file) {
  return ::fdatasync(file) == 0 || errno == EINVAL || errno == ENOSYS;
}
// The same of the names in the folder of a file.
void store_name(const std::string& path) {
  const std::string folder = std::filesystem::absolute(path).parent_path();
  Descriptor opened;
  opened.number = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened.number < 0 || !reaches_disk(opened.number)) fail(path, "its name cannot be stored");
}

std::string shard_words(Shard shard) {
  return std::to_string(shard.number + 1) + "/" + std::to_string(shard.of);
}

}  // namespace

Descriptor::~Descriptor() {
  if (number >= 0) ::close(number);
}

Results::Results(const Study& study, std::string path, Shard shard, bool resume)
    : study_(study),
      path_(std::move(path)),
      journal_(path_ + ".runs"),
      shard_(shard),
      has_(study.runs(), false) {
  { const OutputFile writable(path_); }  // a path that cannot be written costs nothing
  std::error_code unknown;
  if (resume && !std::filesystem::exists(journal_, unknown) &&
      std::filesystem::exists(path_, unknown)) {
    const TableFile file(path_);
    if (file.study() != study.text() || file.shard().number != shard.number ||
        file.shard().of != shard.of)
      throw StudyError({{path_, "it is of another study or shard", "another --out"}});
    finished_ = true;
    return;
  }
  open(resume);
}

Results::~Results() {
  if (file_.number >= 0 && stored_.empty()) ::unlink(journal_.c_str());  // it holds no run
}

void Results::open(bool resume) {
  file_.number = ::open(journal_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_.number < 0) fail(journal_, "cannot write");
  if (::flock(file_.number, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw StudyError({{journal_, "another process is at this study", "another --out"}});
  const bool empty = ::lseek(file_.number, 0, SEEK_END) == 0;
  if (!empty && !resume)
    throw StudyError({{journal_, "it is of a study that was cut off",
                       "--resume (resume=True) to go on with it; or remove it"}});
  if (!empty) read_journal();
  if (end_ > 0) return;
  if (::ftruncate(file_.number, 0) != 0) fail(journal_, "cannot write");
  write_frame(shard_words(shard_) + " " + study_.text());
  store();
  store_name(journal_);
}

// Takes in all whole records; what was cut off in the middle is dropped.
void Results::read_journal() {
  for (Frame frame; read_all(file_.number, reinterpret_cast<char*>(&frame), sizeof frame, end_);) {
    const auto bytes = std::uint64_t(::lseek(file_.number, 0, SEEK_END));
    if (frame.magic != Frame().magic || frame.size > bytes) break;
    std::string payload(frame.size, '\0');
    if (!read_all(file_.number, payload.data(), frame.size, end_ + sizeof frame)) break;
    if (sum_of(payload) != frame.sum) break;
    if (end_ == 0 && payload != shard_words(shard_) + " " + study_.text())
      throw StudyError({{journal_, "it is of another study or shard", "another --out"}});
    if (end_ > 0) {
      const Record record = record_of(payload);
      const std::uint64_t at = end_ + sizeof frame;
      has_.at(record.run) = true;
      stored_.push_back({record.run, record.particles, frame.size,
                         [this, at, size = frame.size] { return read_at(at, size); }});
    }
    end_ += sizeof frame + frame.size;
  }
  if (end_ > 0 && ::ftruncate(file_.number, off_t(end_)) != 0) fail(journal_, "cannot write");
  if (end_ == 0)
    throw StudyError({{journal_, "it is no journal of a study", "another --out; or remove it"}});
}

void Results::write_frame(const std::string& payload) {
  const Frame frame{.sum = sum_of(payload), .size = payload.size()};
  std::string bytes(reinterpret_cast<const char*>(&frame), sizeof frame);
  bytes += payload;
  if (!write_all(file_.number, bytes.data(), bytes.size(), end_)) {
    const int why = errno;
    // A part that stays all the same is told from a whole one by its sum.
    [[maybe_unused]] const int cut = ::ftruncate(file_.number, off_t(end_));
    errno = why;
    fail(journal_, "writing failed" + std::string(kStays));
  }
  end_ += bytes.size();
}

Record Results::read_at(std::uint64_t offset, std::uint64_t size) const {
  std::string bytes(size, '\0');
  if (!read_all(file_.number, bytes.data(), size, offset)) fail(journal_, "cannot be read");
  return record_of(bytes);
}

std::vector<std::uint64_t> Results::missing() const {
  std::vector<std::uint64_t> runs;
  if (finished_) return runs;
  for (std::uint64_t run = shard_.number; run < study_.runs(); run += shard_.of)
    if (!has_[run]) runs.push_back(run);
  return runs;
}

void Results::append(const Record& record) {
  const std::string bytes = to_bytes(record);
  const std::lock_guard hold(mutex_);
  if (record.run >= study_.runs() || !shard_.has(record.run) || has_[record.run] ||
      record.row.size() != study_.row_bytes())
    throw std::invalid_argument("run " + std::to_string(record.run) + " is not asked for");
  write_frame(bytes);
  has_[record.run] = true;
  stored_.push_back(
      {record.run, record.particles, bytes.size(),
       [this, at = end_ - bytes.size(), size = bytes.size()] { return read_at(at, size); }});
}

void Results::store() {
  if (!reaches_disk(file_.number)) fail(journal_, "storing failed" + std::string(kStays));
}

void Results::finish() {
  if (finished_) return;
  if (!missing().empty()) throw std::invalid_argument("there are runs missing");
  std::ranges::sort(stored_, {}, &Stored::run);
  try {
    OutputFile file(path_);
    write_table(file, study_, shard_, stored_);
    file.commit();
  } catch (const WriteError& error) {
    throw WriteError(error.path, error.what() + std::string(kStays));
  }
  store_name(path_);  // not before it is there for good may the journal go
  ::unlink(journal_.c_str());
  finished_ = true;
}

bool run_study(const Study& study, const StudyOptions& options) {
  Results results(study, options.path, options.shard, options.resume);
  const std::vector<std::uint64_t> runs = results.missing();
  const std::uint64_t all = options.shard.runs(study), before = all - runs.size();
  const int jobs = thread_count(options.jobs), each = threads_for_each(jobs, runs.size());
  std::uint64_t done = before;
  std::mutex mutex;
  try {
    run_jobs(runs.size(), jobs, [&](std::size_t k) {
      results.append(study.run(runs[k], each, options.keep_going));
      results.store();  // a run that is told of is safe; others go on meanwhile
      const std::lock_guard hold(mutex);
      options.progress(++done, all, before);
    });
  } catch (const Abandoned&) {
    return false;
  }
  results.finish();
  return true;
}

namespace {

// All shards are open at once, and a process begins with a limit below what the system lets it have.
void allow_open_files(std::size_t count) {
  struct rlimit limit {};
  const rlim_t needed = count + 64;  // and what the process has open besides
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= needed) return;
  if (limit.rlim_max < needed)
    throw StudyError({{"--merge", std::to_string(count) + " shards are too many files to open",
                       "at most " + std::to_string(limit.rlim_max) + " here, see ulimit -Hn"}});
  limit.rlim_cur = needed;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

void merge_study(const std::vector<std::string>& shards, const std::string& path) {
  if (shards.empty()) throw StudyError({{"--merge", "there are no shards", "at least one file"}});
  allow_open_files(shards.size());
  OutputFile out(path);
  std::vector<TableFile> files;
  for (const std::string& shard : shards) files.emplace_back(shard);
  const Study study(files.at(0).study(), "");
  std::vector<Stored> all;
  std::vector<bool> has(study.runs(), false);
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (files[k].study() != study.text())
      throw StudyError({{shards[k], "it is of another study than " + shards[0], ""}});
    for (Stored& s : files[k].records(study)) {
      if (s.run >= study.runs() || has[s.run])
        throw StudyError({{shards[k], "run " + std::to_string(s.run) + " is there twice", ""}});
      has[s.run] = true;
      all.push_back(std::move(s));
    }
  }
  const auto gap = std::ranges::find(has, false);
  if (gap != has.end())
    throw StudyError(
        {{"--merge", std::to_string(std::ranges::count(has, false)) + " runs are missing",
          "the first is run " + std::to_string(gap - has.begin())}});
  std::ranges::sort(all, {}, &Stored::run);
  write_table(out, study, Shard{}, all);
  out.commit();
}

}  // namespace weft
