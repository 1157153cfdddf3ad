// The simulation's thread.
#include "run/session.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>

#include "weft/takeover.h"

namespace weft::viewer {

using std::chrono::steady_clock;

namespace {

constexpr int kYielding = 5;  // nice value

}  // namespace

Session::Session(Scene scene, const Options& options, bool paused, bool hashes)
    : player_(std::move(scene), options, hashes) {
  player_.pause(paused);
  publish();
  shown_.take();
  thread_ = std::thread([this] { run(); });
}

Session::~Session() {
  end();
  if (thread_.joinable()) thread_.join();
}

std::string Session::end() {
  {
    std::unique_lock lock(mutex_);
    stopping_ = true;
    wake_.notify_one();
    left_.wait_for(lock, kGrace, [this] { return over_; });
    if (!over_) return player_.outputs().finish();
  }
  if (thread_.joinable()) thread_.join();
  return player_.outputs().finish();
}

void Session::post(Command command) {
  {
    const std::lock_guard lock(mutex_);
    commands_.push_back(std::move(command));
  }
  wake_.notify_one();
}

bool Session::dispatch() {
  std::vector<Command> commands;
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return true;
    commands.swap(commands_);
  }
  for (const Command& command : commands) command(player_);
  return !commands.empty();
}

void Session::publish() {
  player_.show(shown_.back());
  shown_.publish();
}

void Session::run() {
  // Where processors are short the window comes first; the threads of the simulation inherit this.
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kYielding);
  const auto origin = steady_clock::now();
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      const auto ready = [&] { return stopping_ || !commands_.empty(); };
      if (player_.idle())
        wake_.wait(lock, ready);
      else
        wake_.wait_for(lock, std::chrono::milliseconds(1), ready);
      if (stopping_) break;
    }
    if (dispatch()) publish();  // before a frame that may be long
    const double now = std::chrono::duration<double>(steady_clock::now() - origin).count();
    // A command in between is dispatched at once, however slow the frames are, and before the frame is shown: who
    // pauses is not shown it twice.
    for (int due = player_.due(now); due > 0; --due) {
      player_.advance();
      const bool asked = dispatch();
      publish();
      if (asked) break;
    }
  }
  const std::lock_guard lock(mutex_);
  over_ = true;
  left_.notify_one();
}

}  // namespace weft::viewer
