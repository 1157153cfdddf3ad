// The simulation as a person plays it: its clock, the ring of past states, what is written. Lives on
// the simulation's thread alone (session.h), except for its outputs.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "run/outputs.h"
#include "run/rewind.h"
#include "run/telemetry.h"
#include "weft/clock.h"

namespace weft::viewer {

class Player {
 public:
  // The scene is valid.
  Player(Scene scene, const Options& options, bool hashes);

  // A scene from its start.
  void open(Scene scene);
  // The scene with other values; what moves goes on where that makes sense.
  void change(Scene scene);
  void reset() { open(scene_); }
  // Threads and instruction set: the same bits, another speed.
  void set_options(int threads, Simd simd);

  void pause(bool paused);
  void step();
  void set_speed(double speed) { clock_.set_speed(speed); }
  void hand(const Input& input);

  // Shows the state `back` before the newest kept, paused; going on forgets what came after.
  void go_back(int back);

  // Records from the start of the scene, which begins anew.
  void record(const std::string& path);
  void finish_recording();

  // Exports the animation of the frames first … last, or until finish_export(), in a format of weft/output.h.
  // Where it is past the first, the scene starts anew.
  void export_to(const std::string& path, std::optional<std::int64_t> first,
                 std::optional<std::int64_t> last);
  void finish_export();

  // No frame begins at or after this time of the simulation [s]: a film waits there for its picture.
  void wait_at(double time) { wait_at_ = time; }

  // Frames due at `now` [s], and one of them.
  int due(double now);
  void advance();
  const Telemetry& telemetry() const { return telemetry_; }
  bool idle() const { return clock_.paused(); }
  Outputs& outputs() { return outputs_; }

  // Copies what is to be shown.
  void show(Shown& shown);

 private:
  template <class Do>
  void attempt(Do&& action);
  void give(const Input& input);
  void start(Scene scene);
  void show_scene();
  void restart_clock();
  void leave_past();
  void lay_back();
  void tell(const std::string& problem);
  void tell_written(const std::string& path);
  void measure_sometimes();
  void keep_state();

  Scene scene_;  // as opened or changed last
  Options options_;
  bool hashes_;
  std::unique_ptr<Simulation> simulation_;
  FixedStepClock clock_;
  Rewind rewind_;
  int back_ = 0;
  int until_keep_ = 1;                                        // frames
  double wait_at_ = std::numeric_limits<double>::infinity();  // s
  Outputs outputs_;

  std::shared_ptr<const Scene> shown_scene_;
  std::uint64_t serial_ = 0, change_ = 0;
  Telemetry telemetry_;
  double next_measure_ = 0;  // s
  struct {
    double since = 0;  // s
    std::int64_t frames = 0;
  } pace_;
};

}  // namespace weft::viewer
