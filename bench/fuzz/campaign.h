// Many scenes, several at once, each in a process of its own.
#pragma once

#include <cinttypes>
#include <list>
#include <map>
#include <memory>
#include <string>

#include "child.h"
#include "examine.h"
#include "log.h"

namespace fuzz {

struct Settings {
  std::uint64_t first = 0, count = 100;
  double seconds = 0;    // after which none is started; 0: no end
  double limit = 120;    // s of processor time, of one scene
  double quick = 1e300;  // ms that the other build took, of scenes that are compared
  int jobs = 1;
  bool resume = false;
  Variants variants = Variants::all;
  std::string log, compare, folder = "fuzz_failures";
};

// Examines a case here and now: "SCENE RESULT ANSWER", hashes in hexadecimal digits.
std::string examined(const Case& c, Variants variants, const std::string& folder);

// The examination of a case in a process of its own.
class Examination {
 public:
  Examination(const std::function<Case()>& make, std::uint64_t seed, const Settings& settings);
  // Null while it runs.
  std::optional<Entry> answer();
  std::uint64_t seed() const { return seed_; }

 private:
  std::uint64_t seed_;
  double limit_;        // s
  std::string errors_;  // file of what it says
  Child child_;
};

// Waits for it.
Entry examined_apart(const Case& c, const Settings& settings);

class Campaign {
 public:
  explicit Campaign(Settings settings);
  // Runs all; the exit code.
  int run();

 private:
  double elapsed() const;  // s
  bool more(std::uint64_t& next) const;
  void collect();
  void compare(std::uint64_t seed, Entry& entry) const;
  void count(std::uint64_t seed, const Entry& entry);
  void keep_failure(std::uint64_t seed, const Entry& entry) const;

  Settings settings_;
  Log log_;
  std::map<std::uint64_t, Entry> other_, done_;  // another build's log, and our own so far
  std::list<Examination> running_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  int all_ = 0, failed_ = 0, fresh_ = 0;
  std::uint64_t slowest_ = 0;
  double slowest_ms_ = 0;
};

}  // namespace fuzz
