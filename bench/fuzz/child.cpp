#include "child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <system_error>

namespace fuzz {

namespace {

constexpr double kPatience = 10;  // times the limit: what waits for ever uses no processor

[[noreturn]] void work_and_leave(const std::function<std::string()>& work, int out,
                                 const std::string& errors) {
  const int file = open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0 || dup2(file, STDERR_FILENO) < 0) _exit(3);
  const std::string answer = work();
  for (std::size_t done = 0; done < answer.size();) {
    const ssize_t n = write(out, answer.data() + done, answer.size() - done);
    if (n <= 0) _exit(3);
    done += std::size_t(n);
  }
  _exit(0);
}

}  // namespace

Child::Child(const std::function<std::string()>& work, const std::string& errors) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  std::fflush(nullptr);
  process_ = fork();
  if (process_ < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (process_ == 0) work_and_leave(work, ends[1], errors);
  close(ends[1]);
  pipe_ = ends[0];
  fcntl(pipe_, F_SETFL, O_NONBLOCK);
}

Child::~Child() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  close(pipe_);
}

double Child::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

double Child::processor_seconds() const {
  clockid_t clock;
  timespec used{};
  if (clock_getcpuclockid(process_, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0;
  return double(used.tv_sec) + 1e-9 * double(used.tv_nsec);
}

std::optional<std::string> Child::answer(double limit) {
  const auto read_on = [&] {
    char bytes[4096];
    for (ssize_t n; (n = read(pipe_, bytes, sizeof bytes)) > 0;)
      text_.append(bytes, std::size_t(n));
  };
  read_on();
  int state = 0;
  if (waitpid(process_, &state, WNOHANG) != process_) {
    if (processor_seconds() < limit && seconds() < kPatience * limit) return std::nullopt;
    kill(process_, SIGKILL);
    waitpid(process_, &state, 0);
    process_ = -1;
    return "hang: ran for " + std::to_string(int(limit)) + " s";
  }
  process_ = -1;
  read_on();
  if (WIFSIGNALED(state)) return "crash: signal " + std::to_string(WTERMSIG(state));
  if (WEXITSTATUS(state) != 0) return "exit: status " + std::to_string(WEXITSTATUS(state));
  return text_;
}

}  // namespace fuzz
