// Results of a study on their way to its file. Each finished run is appended to a journal beside it,
// FILE.h5.runs, at once, and store() waits until the disk has it: whatever ends the program or the machine,
// only runs in flight are lost. When all are there, FILE.h5 is written as a whole, and the journal goes.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "study/study.h"
#include "study/table_file.h"

namespace weft {

// A file of the system's, closed at the end.
struct Descriptor {
  int number = -1;
  Descriptor() = default;
  ~Descriptor();
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
};

class Results {
 public:
  // Opens the journal and locks it. `resume`: takes over what one of the same study and shard holds;
  // else there must be none. Throws StudyError, WriteError.
  Results(const Study& study, std::string path, Shard shard, bool resume);
  // Removes the journal where it holds no run.
  ~Results();
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;

  // Runs of the shard that have no record yet, in order.
  std::vector<std::uint64_t> missing() const;
  // Threads may share it. A record of a run that is there already, or not of this shard, is refused by
  // std::invalid_argument. Where the disk is full nothing of the record stays (WriteError).
  void append(const Record& record);
  // Returns when the disk has all that was appended before: not even a power cut loses it then. Threads may
  // share it, and append meanwhile. Throws WriteError.
  void store();
  // Writes the file and removes the journal. Nothing may be missing.
  void finish();

 private:
  void open(bool resume);
  void read_journal();
  void write_frame(const std::string& payload);
  Record read_at(std::uint64_t offset, std::uint64_t size) const;

  const Study& study_;
  std::string path_, journal_;
  Shard shard_;
  Descriptor file_;
  std::uint64_t end_ = 0;  // of the last whole record
  std::vector<Stored> stored_;
  std::vector<bool> has_;  // of all runs of the study
  bool finished_ = false;  // the file was there already
  std::mutex mutex_;
};

struct StudyOptions {
  std::string path;
  Shard shard{};
  bool resume = false;
  int jobs = 0;  // threads; 0 = all cores
  // Asked before every frame, from any thread: false gives up the runs in flight.
  std::function<bool()> keep_going = [] { return true; };
  // Told after every run, one at a time: runs done now, runs of the shard, those done before it began.
  std::function<void(std::uint64_t, std::uint64_t, std::uint64_t)> progress = [](auto, auto, auto) {
  };
};

// Runs what is missing and writes the file; false when keep_going() ended it, with the journal left.
bool run_study(const Study& study, const StudyOptions& options);

// Makes one file of those of all shards. Throws StudyError where some are missing or do not belong
// together.
void merge_study(const std::vector<std::string>& shards, const std::string& path);

}  // namespace weft
