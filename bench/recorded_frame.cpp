// Runs and records a frame (recorded_frame.h).
#include "recorded_frame.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>

#include "physics/frame/state.h"

namespace bench {
namespace {

using State = weft::Simulation::State;

// Frames of seconds are the same however often they are run: after so long, two of them do. Short ones as a whole
// are disturbed more easily than their tasks, and are run for so long at least.
constexpr double kLongNanoseconds = 2e9, kShortNanoseconds = 1e9;

// Ready for the frame: stages begin anew after a restored state, and make room.
void go_before(State& state, const weft::Snapshot& snapshot) {
  state.restore(snapshot);
  state.advance_frame();
}

double frame_ns(State& state) {
  const auto start = std::chrono::steady_clock::now();
  state.advance_frame();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

RecordedFrame::RecordedFrame(const weft::Scene& scene, int first) : scene_(scene) {
  weft::Simulation simulation(scene, {});
  for (int n = 0; n < first; ++n) simulation.advance_frame();
  if (!simulation.status().ok) throw std::runtime_error(simulation.status().text);
  before_ = simulation.snapshot();
  substeps_ = simulation.substeps();
}

RecordedFrame::~RecordedFrame() = default;

RecordedFrame::Times RecordedFrame::measure(int threads, int repeats) {
  State one(scene_, {.threads = 1}, before_.origin),
      several(scene_, {.threads = threads}, before_.origin);
  Times least{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  double spent = 0;
  for (int n = 0; n < 2 || spent < kShortNanoseconds || (n < repeats && spent < kLongNanoseconds);
       ++n) {
    go_before(one, before_);
    least.one = std::min(least.one, frame_ns(one));
    go_before(several, before_);
    least.several = std::min(least.several, frame_ns(several));
    spent += least.one + least.several;
  }
  return least;
}

TaskGraph RecordedFrame::record(int threads, int repeats) {
  State state(scene_, {.threads = threads}, before_.origin);
  weft::physics::TaskRecord record;
  state.runner.threads().record(&record);
  TaskGraph shortest;
  double spent = 0;
  for (int n = 0; n < repeats && (n < 2 || spent < kLongNanoseconds); ++n) {
    go_before(state, before_);
    record.begin_frame();
    state.advance_frame();
    record.end_frame();
    if (n == 0)
      shortest = graph_of(record);
    else
      shortest.take_shorter(graph_of(record));
    spent += shortest.work_ns();
  }
  return shortest;
}

}  // namespace bench
