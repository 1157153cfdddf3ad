// Work in a process of its own, so that a crash, a sanitizer's report or a hang ends that alone.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>

namespace fuzz {

class Child {
 public:
  // Runs work() in a child process; what it returns comes back in answer(). Standard error goes to a
  // file.
  Child(const std::function<std::string()>& work, const std::string& errors);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // The answer once the child has ended: what work() returned, "crash: signal 11", "exit: status 1", or
  // "hang: …" when it took more than `limit` seconds of processor time, or ten times as long. Null while it
  // runs.
  std::optional<std::string> answer(double limit);

  double seconds() const;  // since the start

 private:
  double processor_seconds() const;  // of all its threads

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  pid_t process_ = -1;
  int pipe_ = -1;
  std::string text_;
};

}  // namespace fuzz
