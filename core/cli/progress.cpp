// Progress and summary as text.
#include "progress.h"

#include <unistd.h>

#include <array>
#include <cinttypes>
#include <cstdarg>
#include <cstdio>
#include <iostream>

#include "failure.h"
#include "weft/printable.h"

namespace weft::cli {

namespace {

__attribute__((format(printf, 1, 2))) std::string format(const char* pattern, ...) {
  std::array<char, 256> line{};
  va_list values;
  va_start(values, pattern);
  std::vsnprintf(line.data(), line.size(), pattern, values);
  va_end(values);
  return line.data();
}

}  // namespace

Progress::Progress(std::int64_t frames, double frame_seconds)
    : terminal_(::isatty(STDOUT_FILENO) == 1),
      frames_(frames),
      frame_seconds_(frame_seconds),
      start_(Clock::now()),
      last_(start_) {}

void Progress::update(std::int64_t done) {
  if (!terminal_) return;
  const Clock::time_point now = Clock::now();
  const double passed = std::chrono::duration<double>(now - last_).count();
  if (passed < 1) return;
  const auto fresh = static_cast<double>(done - done_at_last_);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double left = elapsed / static_cast<double>(done) * static_cast<double>(frames_ - done);
  std::cout << format("frame %6" PRId64 " of %" PRId64
                      "  %3.0f %%  %8.2f s simulated  "
                      "%8.2f ms a frame  %6.2fx real time  %.0f s left",
                      done, frames_,
                      100.0 * static_cast<double>(done) / static_cast<double>(frames_),
                      static_cast<double>(done) * frame_seconds_, passed / fresh * 1e3,
                      fresh * frame_seconds_ / passed, left)
            << std::endl;
  last_ = now;
  done_at_last_ = done;
}

std::string summary(const Report& report, const std::vector<std::string>& notes,
                    const std::vector<std::string>& written) {
  const auto& constraints = report.constraints;
  const auto& wall = report.wall_ms;
  const auto& energy = report.energy;
  const auto& penetration = report.penetration;
  std::string text = "scene     " + printable(report.scene) + "\n";
  text += format("cloth     %" PRId64 " particles, %" PRId64 " structural + %" PRId64
                 " shear + %" PRId64 " bend constraints\n",
                 report.particles, constraints.structural, constraints.shear, constraints.bend);
  text +=
      format("time      %" PRId64 " frames, %" PRId64 " substeps of %.4g ms: %.4g s simulated\n",
             report.frames, report.substeps, report.dt * 1e3, report.sim_seconds);
  const double factor = wall.total > 0 ? report.sim_seconds / (wall.total * 1e-3) : 0;
  text += format(
      "speed     %.3g ms a frame (median; 99 %% within %.3g), %.3gx real time, "
      "%d thread%s, %s\n",
      wall.frame_median, wall.frame_p99, factor, report.threads, report.threads == 1 ? "" : "s",
      report.simd.c_str());
  text += format("energy    kinetic %.4g J, elastic %.4g J, gravity %.4g J, total %.4g J\n",
                 energy.kinetic, energy.elastic, energy.gravity, energy.total);
  text += format("strain    greatest %.3g %%, mean %.3g %%\n", report.strain.max * 100,
                 report.strain.mean * 100);
  text +=
      format("contact   deepest %.3g mm below a collider; %" PRId64
             " pairs of the cloth too close, deepest %.3g mm\n",
             penetration.collider_max * 1e3, penetration.self_pairs, penetration.self_max * 1e3);
  for (const std::string& note : notes) text += "note      " + note + "\n";
  if (report.torn > 0) text += format("torn      %" PRId64 " constraints\n", report.torn);
  text += format("hash      %016" PRIx64 "\n", report.hash);
  if (!written.empty()) text += "wrote     " + list(written) + "\n";
  return text;
}

}  // namespace weft::cli
