// Everything a simulation holds, and the frame.
#pragma once

#include <atomic>
#include <deque>

#include "physics/plan.h"
#include "physics/self_collision/self_collision.h"
#include "physics/stability.h"
#include "physics/stages/grab.h"
#include "physics/threads.h"
#include "weft/simulation.h"

namespace weft {

struct Simulation::State {
  State(Scene given, const Options& given_options);

  void advance_frame();
  void grab(int cloth, int i, int j, const Vec3& target, double stiffness);
  void release();
  void hold(int cloth, int i, int j, bool held);
  void set(std::span<const double> positions, std::span<const double> velocities);
  std::size_t backup_bytes() const;

  Scene scene;  // as simulated; never changes
  Options options;
  Simd simd;
  physics::Threads threads;
  physics::Threads one_thread;  // for cloths too small to share out
  Method method;                // the scene's, or the stable one put in its place
  std::vector<std::unique_ptr<physics::ClothStep>> cloths;
  std::unique_ptr<physics::SelfContact> self_collision;  // over all cloths; null when all are off
  Plan plan;
  Status status;
  std::int64_t frame = 0, total_substeps = 0;
  std::uint64_t changes = 0;  // state set from outside
  int substeps = 1;
  double dt = 0;
  std::vector<physics::Spectrum> spectra;  // of every cloth at the start (explicit springs)

  // Wall time of every frame [ms]; reserved ahead for the scene's own length.
  std::vector<float> frame_ms;
  double total_ms = 0;
  std::deque<std::vector<std::atomic<std::int64_t>>> stage_ns;  // per cloth, per stage (profile)
  std::int64_t self_collision_ns = 0, self_collision_runs = 0;

 private:
  struct Backup {
    physics::Rows x, v;
  };
  std::vector<Backup> backups_;
  physics::Grab* grab_ = nullptr;  // in the plan of cloth grabbed_
  int grabbed_ = 0;
  int since_collision_ = 0, until_collision_ = 1;  // substeps
  std::vector<Vec3> accelerations_;  // of one cloth, kept where automatic substeps change (explicit)

  void choose_method_and_substeps();
  void build_cloths();
  void set_substeps(int count);
  void shift_velocities(double by, const double* from = nullptr);
  void follow_stretch();
  void run_frame();
  physics::ClothStep& step_with(int cloth, int i, int j);
  void plan_changed();
  void run_substeps(int first, int count);
  void save();
  void restore();
  bool finite() const;
  void find_fault();
};

}  // namespace weft
