// Estimates in words (needs.h).
#include "needs.h"

#include <cinttypes>
#include <cstdio>

#include "failure.h"

namespace weft::cli {

namespace {

constexpr double kLongRun = 120;          // s
constexpr double kMostBytes = 32 * 1024;  // that a particle takes, in rows of two of them

}  // namespace

std::string needs_words(const Estimate& needed) {
  std::string text = "needs about " + bytes_words(needed.bytes) + " of memory and " +
                     time_words(needed.frame_seconds) + " a frame on one thread (" +
                     std::to_string(needed.substeps) + " substeps; a rough figure)\n";
  if (needed.bytes > free_memory())
    text += "note: " + bytes_words(free_memory()) + " of memory are free\n";
  // Said of every run that may take that long, the figure being as rough as it is.
  if (needed.run_seconds() * kTimeWithin > kLongRun) {
    char frames[32];
    std::snprintf(frames, sizeof frames, "%.0f", needed.frames);
    text += "note: its " + std::string(frames) + " frames take about " +
            time_words(needed.run_seconds()) + " on one thread, and up to " +
            time_words(kTimeWithin * needed.run_seconds()) + " with much contact\n";
  }
  return text;
}

void require_memory(const Scene& scene, const std::string& place) {
  double particles = 0;
  for (const Cloth& cloth : scene.cloths) particles += particle_count(cloth);
  const double free = free_memory();
  if (particles * kMostBytes < free) return;  // whatever else the scene asks for
  const double needed = estimate(scene).bytes;
  if (needed / kMemoryWithin <= free) return;
  throw Failure{kStopped,
                {{place, "the scene needs about " + bytes_words(needed) + " of memory",
                  "up to the " + bytes_words(free) + " that are free"}}};
}

}  // namespace weft::cli
