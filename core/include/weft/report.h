// What a run tells about itself: the step plan, the status, and the report of contract fields.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "weft/scene.h"

namespace weft {

// One stage of the step plan, in the order of execution.
struct PlannedStage {
  std::string name;            // "forces and integrate"
  std::string detail;          // what it evaluates: "structural, shear, bend; leapfrog"
  double calls_per_frame = 0;  // how often
  std::int64_t items = 0;      // how many it touches per call
  std::string item;            // what an item is: "particles", "constraints", "pairs"
};

// A stage that the scene does not need, and why.
struct SkippedStage {
  std::string name;
  std::string why;
};

struct Plan {
  std::vector<PlannedStage> stages;
  std::vector<SkippedStage> skipped;
  int substeps = 0;       // per frame
  double dt = 0;          // s
  double dt_limit = 0;    // s; the stability limit of explicit methods, 0 when there is none
  bool fallback = false;  // runs another way than the scene asks, to stay stable; notes say how
  std::vector<std::string> notes;  // what was chosen for the user, and why
};

// `ok`, or why the simulation stopped itself: the first frame, stage and particle at fault.
struct Status {
  bool ok = true;
  std::int64_t frame = 0;
  std::string stage;
  int cloth = 0, particle = 0;
  std::string text = "ok";
};

struct StageTime {
  std::string name;
  double ms = 0;
  std::int64_t calls = 0;
};

struct Report {
  std::string scene;
  std::string version;
  std::string compiler;
  std::string simd;
  std::int64_t particles = 0;
  struct {
    std::int64_t structural = 0, shear = 0, bend = 0;
  } constraints;
  std::int64_t frames = 0;
  std::int64_t substeps = 0;  // in all
  double dt = 0;              // s
  double sim_seconds = 0;     // s
  int threads = 0;
  struct {
    double total = 0, frame_min = 0, frame_median = 0, frame_p99 = 0, frame_max = 0;
  } wall_ms;
  std::vector<StageTime> stages;  // sums to wall_ms.total; one entry "step" unless profiled
  std::vector<SkippedStage> skipped;
  std::vector<std::string> notes;  // of the plan, as `weft run` prints them
  std::uint64_t hash = 0;          // of the final positions' bits
  // Kinetic energy and momenta are of half a substep before `sim_seconds` with springs that have a strain
  // limit (what the springs alone would add since, the limit takes back) and with methods that project,
  // where the solver is of the first order.
  struct {
    double kinetic = 0, elastic = 0, gravity = 0, total = 0;  // J
  } energy;
  // J; what of the elastic energy stretches membranes, and what bends: the rest is of springs and gases.
  double membrane_energy = 0, bending_energy = 0;
  Vec3 momentum{};          // kg m/s
  Vec3 angular_momentum{};  // kg m²/s about the origin
  struct {
    double max = 0, mean = 0;
    // The greatest at the end of any frame so far; none unless it was followed (Options::follow_strain).
    std::optional<double> max_of_frames;
  } strain;  // structural, length/rest - 1
  struct {
    double collider_max =
        0;  // m; deepest particle, or point of a triangle that went through, below a collider's surface
    std::int64_t self_pairs = 0;
    double self_max = 0;  // m
    std::int64_t crossings = 0;
  } penetration;
  // Of contact between sheets, from the start of the run to now.
  struct {
    std::int64_t contacts = 0;  // that were solved the last time, among cloths
    double energy_taken = 0;    // J; of motion, by impulses (friction and blows)
    // m; by how much a particle's way was cut at most so that nothing passes.
    double greatest_clamp = 0;
    double least_distance = 1;  // of two that touched, in distances at which they are held
  } contact;
  std::int64_t torn = 0;
  std::int64_t asleep = 0;  // particles at rest that are not worked on
  bool finite = true;
  Status status;
};

// The report as the JSON of the contract, two-space indent, ending in a newline.
std::string to_json(const Report& report);

// The plan as `weft explain` prints it.
std::string to_text(const Plan& plan);

}  // namespace weft
