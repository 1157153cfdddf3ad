// A simulation on a thread of its own. The window asks by commands, which run between two frames,
// and looks at the newest state; neither thread ever waits for the other.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "run/player.h"
#include "run/triple_buffer.h"

namespace weft::viewer {

class Session {
 public:
  // The scene is valid. `hashes`: every state that is shown tells its hash.
  Session(Scene scene, const Options& options, bool paused, bool hashes);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  using Command = std::function<void(Player&)>;
  void post(Command command);

  // Ends after the present frame, or within it where that takes longer than kGrace (weft/takeover.h): then
  // ended() is false, and the process must end without the destructor, which waits for the frame. What is
  // recorded and exported is written, up to the last frame. What went wrong with that, or "".
  std::string end();
  bool ended() const { return !thread_.joinable(); }

  // Whether there is a newer state; shown() is it from then on.
  bool refresh() { return shown_.take(); }
  const Shown& shown() const { return shown_.front(); }

 private:
  void run();
  bool dispatch();  // whether there was anything to do but frames
  void publish();

  Player player_;
  TripleBuffer<Shown> shown_;
  std::mutex mutex_;
  std::condition_variable wake_, left_;
  std::vector<Command> commands_;
  bool stopping_ = false;
  bool over_ = false;  // the thread has left its loop
  std::thread thread_;
};

}  // namespace weft::viewer
