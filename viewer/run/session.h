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

  // Ends after the present frame; what is recorded and exported is written. What went wrong with
  // that, or "". The destructor does it, too.
  std::string end();

  // Whether there is a newer state; shown() is it from then on.
  bool refresh() { return shown_.take(); }
  const Shown& shown() const { return shown_.front(); }

 private:
  void run();
  bool dispatch();  // whether there were commands
  void publish();

  Player player_;
  TripleBuffer<Shown> shown_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Command> commands_;
  bool stopping_ = false;
  std::string problem_;
  std::thread thread_;
};

}  // namespace weft::viewer
