// Physics in fixed steps beside a frame clock that runs free (seed 000): a display of any rate asks
// how many steps are due, and a machine too slow for real time loses time instead of freezing.
//
//   weft::FixedStepClock clock(1.0 / 60);
//   for each frame shown at time `now`:
//     for (int step = clock.advance(now); step > 0; --step) simulation.advance_frame();
//
// Nothing here reads a clock: times are passed in, in seconds from any fixed origin.
#pragma once

#include <cstdint>

namespace weft {

class FixedStepClock {
 public:
  // `step` > 0 [s] is the physics time of one step; at most `max_catch_up` >= 1 steps are due at
  // once. Throws std::invalid_argument otherwise.
  explicit FixedStepClock(double step, int max_catch_up = 8);

  // Steps due at `now` [s] to bring the physics clock up to the frame clock, 0 … max_catch_up.
  // Whatever is then still missing is dropped and reported as lag. The first call sets the origin.
  // A `now` that lies before the last one, or is not finite, counts as no time passed.
  int advance(double now);

  // While paused no time passes; resuming does not make up for it.
  void pause() { paused_ = true; }
  void resume() {
    paused_ = false;
    singles_ = 0;
  }
  bool paused() const { return paused_; }

  // Pauses, and makes exactly one step due at the next advance(); calls add up.
  void single_step();

  // Seconds of physics per second of `now`: 1 is real time, 0.1 slow motion. Finite and >= 0, else
  // std::invalid_argument.
  void set_speed(double speed);
  double speed() const { return speed_; }

  double step() const { return step_; }          // s
  std::int64_t steps() const { return steps_; }  // made due since the start
  double time() const;                           // s, the physics clock: steps() * step()
  double lag() const { return lag_; }            // s of physics dropped by the last advance
  double dropped() const { return dropped_; }    // s of physics dropped since the start

  // Where the frame clock stands between the last two physics states, 0 … 1: draw
  // previous + (current - previous) * blend() for motion as smooth as the display.
  double blend() const;

 private:
  double step_;
  int max_catch_up_;
  double speed_ = 1;
  double last_ = 0;    // s, `now` of the last advance
  double behind_ = 0;  // s, frame clock minus physics clock; within (-step, 0] after an advance
  double lag_ = 0;
  double dropped_ = 0;
  std::int64_t steps_ = 0;
  int singles_ = 0;  // single steps asked for
  bool started_ = false;
  bool paused_ = false;
};

}  // namespace weft
