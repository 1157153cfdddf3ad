// What each request does to the simulation.
#include "run/player.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "edit/cloth_place.h"
#include "picture/cpu_time.h"
#include "weft/printable.h"

namespace weft::viewer {

namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Whether every cut of the second scene is in the first, or the beginning of one there.
bool contains_cuts(const Scene& scene, const Scene& other) {
  if (scene.cloths.size() != other.cloths.size()) return true;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c)
    for (const CutLine& cut : other.cloths[c].cuts) {
      const auto goes_on = [&](const CutLine& line) {
        return line.size() >= cut.size() && std::equal(cut.begin(), cut.end(), line.begin());
      };
      const auto& lines = scene.cloths[c].cuts;
      if (std::none_of(lines.begin(), lines.end(), goes_on)) return false;
    }
  return true;
}

}  // namespace

Player::Player(Scene scene, const Options& options, bool hashes)
    : options_(options), hashes_(hashes), clock_(scene.time.frame) {
  options_.profile = true;
  start(std::move(scene));
}

// A request that fails is told and changes nothing else.
template <class Do>
void Player::attempt(Do&& action) {
  try {
    action();
  } catch (const WriteError& error) {
    tell(printable(error.path) + ": " + error.what());
  } catch (const std::exception& error) {
    tell(error.what());
  }
}

void Player::tell(const std::string& problem) {
  telemetry_.problem = problem;
  ++telemetry_.problems;
}

void Player::start(Scene scene) {
  auto simulation = std::make_unique<Simulation>(scene, options_);
  scene_ = std::move(scene);
  simulation_ = std::move(simulation);
  restart_clock();
  rewind_.clear();
  rewind_.keep(simulation_->snapshot());
  back_ = 0;
  ++serial_;
  show_scene();
  next_measure_ = 0;
}

void Player::show_scene() {
  const Vec3 origin = simulation_->view().origin;
  shown_scene_ = std::make_shared<const Scene>(moved(scene_, {-origin[0], -origin[1], -origin[2]}));
}

void Player::restart_clock() {
  const bool paused = clock_.paused();
  const double speed = clock_.speed();
  clock_ = FixedStepClock(scene_.time.frame);
  clock_.set_speed(speed);
  if (paused) clock_.pause();
}

void Player::open(Scene scene) {
  attempt([&] {
    finish_recording();
    finish_export();
    start(std::move(scene));
  });
}

void Player::change(Scene scene) {
  attempt([&] {
    if (moves_alike(scene, scene_)) {
      simulation_->draw_as(scene);
      scene_ = std::move(scene);
      show_scene();
      ++serial_;
      return;
    }
    leave_past();
    if (simulation_->frame() == 0 && !outputs_.recording()) {
      start(std::move(scene));
      return;
    }
    if (starts_elsewhere(scene, scene_)) {
      open(std::move(scene));
      return;
    }
    const bool heals = !contains_cuts(scene, scene_);
    Input input{.kind = Input::Kind::set_scene};
    input.scene = std::make_shared<const Scene>(scene);
    give(input);
    if (heals) lay_back();
    if (simulation_->frame() == 0) finish_export();  // another grid
    const bool same = scene.cloths.size() == scene_.cloths.size() &&
                      scene.colliders.size() == scene_.colliders.size();
    if (!same || simulation_->frame() == 0) rewind_.clear();
    scene_ = std::move(scene);
    if (clock_.step() != scene_.time.frame) restart_clock();
    if (rewind_.size() == 0) rewind_.keep(simulation_->snapshot());
    show_scene();
    ++serial_;
    next_measure_ = 0;
  });
}

// A cut that is taken back: a cloth lies as it did before, where that is kept. Springs that join what has
// fallen apart would throw it about.
void Player::lay_back() {
  weft::Snapshot now = simulation_->snapshot();
  bool found = false;
  for (std::size_t c = 0; c < now.cloths.size(); ++c) {
    int back = 0;
    for (; back < rewind_.size(); ++back) {
      const weft::Snapshot& then = rewind_.at(back);
      if (then.cloths.size() != now.cloths.size() || then.origin != now.origin ||
          then.cloths[c].positions.size() != now.cloths[c].positions.size() ||
          then.cloths[c].torn.size() > now.cloths[c].torn.size())
        continue;
      now.cloths[c].positions = then.cloths[c].positions;
      now.cloths[c].velocities = then.cloths[c].velocities;
      found = found || back > 0;
      break;
    }
    if (back == rewind_.size())
      tell("How cloth " + std::to_string(c) +
           " lay before it was cut is no longer kept: its parts are pulled together from where "
           "they are");
  }
  if (!found) return;
  finish_recording();  // no input says this
  simulation_->restore(now);
  ++change_;
}

void Player::set_options(int threads, Simd simd) {
  attempt([&] {
    Options options = options_;
    options.threads = threads;
    options.simd = simd;
    auto next = std::make_unique<Simulation>(simulation_->scene(), options);
    next->restore(simulation_->snapshot());
    simulation_ = std::move(next);
    options_ = options;
    ++serial_;
  });
}

void Player::pause(bool paused) {
  if (paused) clock_.pause();
  if (!paused) {
    leave_past();
    clock_.resume();
  }
}

void Player::step() {
  leave_past();
  clock_.single_step();
}

void Player::hand(const Input& input) {
  attempt([&] {
    leave_past();
    give(input);
    ++change_;
  });
}

// An input that cannot be applied is not recorded either.
void Player::give(const Input& input) {
  const std::int64_t frame = simulation_->frame();
  apply(input, *simulation_);
  attempt([&] { outputs_.input(frame, input); });
}

void Player::go_back(int back) {
  attempt([&] {
    clock_.pause();
    back_ = std::clamp(back, 0, rewind_.size() - 1);
    finish_recording();
    simulation_->restore(rewind_.at(back_));
    // What a hand held then none holds now.
    simulation_->release();
    for (std::size_t c = 0; c < scene_.cloths.size(); ++c) simulation_->carry(int(c), {});
    ++change_;
  });
}

void Player::leave_past() {
  rewind_.cut(back_);
  back_ = 0;
}

void Player::record(const std::string& path) {
  attempt([&] {
    finish_recording();
    start(scene_);
    outputs_.record(path, *simulation_);
  });
}

void Player::finish_recording() {
  attempt([&] { tell_written(outputs_.finish_recording()); });
}

void Player::export_to(const std::string& path, std::optional<std::int64_t> first,
                       std::optional<std::int64_t> last) {
  attempt([&] {
    if (first && simulation_->frame() > *first) open(scene_);
    outputs_.export_to(path, *simulation_, first.value_or(simulation_->frame()), last);
    if (last && simulation_->frame() >= *last) finish_export();
  });
}

void Player::finish_export() {
  attempt([&] { tell_written(outputs_.finish_export()); });
}

void Player::tell_written(const std::string& path) {
  if (!path.empty()) telemetry_.recorded = path;
}

int Player::due(double now) {
  if (now - pace_.since > 0.5) {
    const auto frames = static_cast<double>(telemetry_.frames - pace_.frames);
    telemetry_.pace = frames * scene_.time.frame / (now - pace_.since);
    pace_ = {now, telemetry_.frames};
  }
  // What is over stays due while nothing may begin, a single step too.
  constexpr double kRounding = 1e-9;  // s
  const double left = wait_at_ - simulation_->time() - kRounding;
  if (left <= 0) return 0;
  const double frames = std::ceil(left / scene_.time.frame);
  const int due = clock_.advance(now);
  return frames < due ? static_cast<int>(frames) : due;
}

void Player::advance() {
  attempt([&] {
    if (!simulation_->status().ok) {
      clock_.pause();
      return;
    }
    const double start = seconds_now();
    simulation_->advance_frame();
    telemetry_.frame_ms = 1e3 * (seconds_now() - start);
    ++telemetry_.frames;
    if (!simulation_->status().ok) return;
    tell_written(outputs_.frame(*simulation_));
    keep_state();
  });
}

// Every frame's, unless that is too much work.
void Player::keep_state() {
  constexpr double kFree = 2;  // ms
  if (--until_keep_ > 0) return;
  const double start = cpu_ms();
  rewind_.keep(simulation_->snapshot());
  until_keep_ = 1 + static_cast<int>((cpu_ms() - start) / kFree);
}

// At most a tenth of the time goes into measuring.
void Player::measure_sometimes() {
  const double now = seconds_now();
  if (now < next_measure_) return;
  telemetry_.report = simulation_->report(false);
  telemetry_.plan = std::make_shared<const Plan>(simulation_->plan());
  ++telemetry_.measured;
  const double took = seconds_now() - now;
  next_measure_ = now + std::max(0.1, 10 * took);
}

void Player::show(Shown& shown) {
  measure_sometimes();
  FrameData& frame_data = shown.frame_data;
  frame_data.scene = shown_scene_;
  frame_data.scene_serial = serial_;
  frame_data.change = change_;
  frame_data.frame = simulation_->frame();
  copy_view(simulation_->view(), simulation_->scene(), frame_data);
  telemetry_.status = simulation_->status();
  telemetry_.substeps = simulation_->substeps();
  telemetry_.threads = simulation_->threads();
  telemetry_.dt = simulation_->dt();
  telemetry_.paused = clock_.paused();
  telemetry_.speed = clock_.speed();
  telemetry_.kept = rewind_.size();
  telemetry_.back = back_;
  telemetry_.kept_s = rewind_.seconds();
  telemetry_.recording = outputs_.recording();
  telemetry_.exporting = outputs_.exporting();
  telemetry_.hash = hashes_ ? simulation_->hash() : 0;
  shown.telemetry = telemetry_;
}

}  // namespace weft::viewer
