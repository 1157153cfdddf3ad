// Everything a simulation holds, and the frame.
#pragma once

#include <atomic>
#include <cstdio>
#include <deque>
#include <optional>

#include "physics/contact/self/self_contact.h"
#include "physics/contact/self/untangle.h"
#include "physics/frame/carry.h"
#include "physics/frame/cloth_step.h"
#include "physics/frame/grab.h"
#include "physics/frame/rollback_buffer.h"
#include "physics/frame/sleeping.h"
#include "physics/frame/step_guard.h"
#include "physics/model/number.h"
#include "physics/step/threads.h"
#include "weft/simulation.h"

namespace weft {

struct Simulation::State {
  // `about`: what positions are counted from; `make`: makes the model of each cloth.
  State(Scene given, const Options& given_options, const Vec3& about,
        physics::MakeModel make = physics::make_model);

  void advance_frame();
  void grab(int cloth, int particle, const Vec3& target, double stiffness);
  void release();
  void carry(int cloth, const Vec3& velocity);
  void let_go();
  void hold(int cloth, int particle, bool held);
  int cut(const Vec3& a, const Vec3& b, double width);
  // Adds a note to the plan that it does not have yet.
  void note_once(const std::string& note);
  // Positions are counted from `from`; velocities lie `behind` them by so much [s]. Not given: as those that
  // velocities() tells where they are these, else not at all.
  void set(std::span<const double> positions, const Vec3& from, std::span<const double> velocities,
           std::optional<double> behind = {});
  void move_collider(int collider, const Vec3& target);
  void set_path(std::size_t collider, std::vector<Key> keys);
  Snapshot snapshot() const;
  // Throws std::invalid_argument for a snapshot that restore() cannot take. (restore() trusts it.)
  void check(const Snapshot& snapshot) const;
  void restore(const Snapshot& snapshot);
  // A collider has been put where cloths may be.
  void meet(std::size_t collider);
  std::size_t record_bytes() const;
  // Adds the notes of strain limits that did not hold, and of seams that are open now. Frames only keep
  // what the first say: they allocate nothing.
  void tell_of_limits();
  void accelerations_now(std::size_t cloth, double behind, std::vector<Vec3>& a) const;

  // As simulated, about the origin; only move_collider(), restore() and go_on_as() change it. And where
  // it stands, unless that is the same.
  Scene scene;
  const Vec3 origin;  // m
  std::optional<Scene> placed;
  const Scene& where_it_stands() const { return placed ? *placed : scene; }
  Options options;
  Simd simd;
  physics::Threads threads;
  physics::Threads one_thread;  // for a cloth that one thread runs, whichever
  Method method;                // the scene's, or the stable one put in its place
  physics::Cloths cloths;
  std::unique_ptr<physics::SelfContact> self_collision;  // over all cloths; null when all are off
  std::unique_ptr<physics::Untangle> untangle;           // null when self_collision is
  std::unique_ptr<physics::Sleeping> sleeping;           // null when nothing may sleep
  // Inverse masses of a cloth, of sleeping particles too.
  const physics::AlignedArray<float>& masses(std::size_t cloth) const {
    return sleeping ? sleeping->masses(cloth) : cloths[cloth]->particles().inverse_mass;
  }
  Plan plan;
  Status status;
  std::int64_t frame = 0, total_substeps = 0;
  std::uint64_t changes = 0;  // state set from outside
  int substeps = 1;
  double dt = 0;
  // s; by which velocities lie behind the positions: half a substep with explicit springs and the first
  // order of methods that project, whose first substep takes them half of it ahead (step/stage.h).
  double lag = 0;
  double lag_between_substeps() const {
    return physics::is_explicit(method) || scene.solver.order == 1 ? dt / 2 : 0;
  }
  std::vector<physics::Spectrum> spectra;  // of every cloth (explicit springs)
  // Constraints that the scene's cuts take, of every cloth, pairs of particles.
  std::vector<std::vector<physics::Joined>> cut_from_start;

  // At the end of any frame; none unless it is followed.
  std::optional<double> greatest_strain;

  // Wall time of every frame [ms]; reserved ahead for the scene's own length.
  std::vector<float> frame_ms;
  double total_ms = 0;
  std::deque<std::vector<std::atomic<std::int64_t>>> stage_ns;  // per cloth, per stage (profile)
  std::int64_t self_collision_ns = 0, self_collision_runs = 0;

 private:
  const physics::MakeModel make_model_;
  std::vector<physics::RollbackBuffer> records_;  // of each cloth
  // The first frame at whose end a cloth was longer somewhere than its strain limit allows.
  struct Overlong {
    std::int64_t frame = 0;  // 0: none
    double strain = 0;
    bool told = false;
  };
  std::vector<Overlong> overlong_;  // of each cloth
  std::vector<std::string> told_of_seams_;
  std::vector<std::size_t> apart_;    // cloths that take a thread each
  std::vector<std::int64_t> busy_;    // of each thread, with so many particles
  std::vector<std::uint8_t> asleep_;  // each cloth as a whole, in this frame
  int saved_substeps_ = 1;
  double saved_lag_ = 0;
  physics::Grab* grab_ = nullptr;  // in the plan of cloth grabbed_
  int grabbed_ = 0;
  std::vector<physics::Carry*> carried_;  // in the plan of each cloth; null while it rests
  int until_collision_ = 1;               // substeps from one run of contact to the next
  bool clamps_noted_ = false, left_strain_noted_ = false;
  std::vector<std::uint8_t> stretch_noted_;  // of every cloth
  physics::StepGuard guard_;
  bool was_driven_ = false;  // in the frame before
  double limit_ = 0;         // s; the stability limit at the end of the last frame (explicit)
  // As the run began, before any of its frames failed.
  struct Beginning {
    Method method;
    Solver solver;
    int substeps = 1;  // a frame
    bool fallback = false;
    std::vector<std::string> notes;
    physics::EnergyGuard energy;
  } began_;

  void choose_method_and_substeps();
  void estimate_spectra();
  void note_starts(std::vector<std::string>& notes) const;
  void build_cloths();
  void make_self_contact();
  void take_substeps(int count);
  void set_substeps(int count);
  void stagger(double by, const double* from = nullptr);
  double stretched_limit() const;
  int substeps_within(double limit) const;
  void follow_stretch(double limit);
  bool carried() const;
  bool driven() const;
  bool sews() const;
  bool loaded(bool changing) const;
  void open_guard();
  bool blown() const { return scene.wind.drag > 0 || scene.wind.lift > 0; }
  int projection_substeps() const;
  // Whether a cloth can be moved by no method that projects.
  physics::FrameRun frame_run();
  bool carry_out(physics::Verdict verdict);
  void change_method(const std::string& which, int count);
  void note_models(std::vector<std::string>& notes) const;
  void begin_again();
  void go_on_as(Method as, const Solver& solver);
  bool nothing_else_acts() const;
  void fall_back(const std::string& note);
  void restart_stages();
  void wake(int cloth = -1);
  void touch(int cloth = -1);
  bool asleep(std::size_t cloth) const { return sleeping && sleeping->rows(cloth).empty(); }
  void run_frame();
  void check_strain_limits();
  void tell_of_seams();
  void run_with_contact();
  physics::ContactInterval contact_interval(int end, int count) const;
  void begin_contact();
  void note_clamps();
  void note_stretch();
  void note_left_strain();
  physics::ClothStep& step_with(int cloth, int particle);
  void plan_changed();
  Plan describe_stages() const;
  physics::Substeps substeps_from(int first, int count) const;
  void run_substeps(int first, int count);
  int particles(std::size_t cloth) const;
  bool keep_busy(const std::vector<std::size_t>& each);
  void save();
  void restore();
  void find_fault();
};

}  // namespace weft
