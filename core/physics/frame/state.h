// A simulation: the parts that it is made of, and what goes through all of them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/frame/cloth_step.h"
#include "physics/frame/frame_notes.h"
#include "physics/frame/frame_start.h"
#include "physics/frame/hands.h"
#include "physics/frame/placed_scene.h"
#include "physics/frame/run_times.h"
#include "physics/frame/sheet_contact.h"
#include "physics/frame/sleeping.h"
#include "physics/frame/step_guard.h"
#include "physics/frame/substep_runner.h"
#include "physics/frame/time_step.h"
#include "weft/simulation.h"

namespace weft {

struct Simulation::State {
  // `about`: what positions are counted from; `make`: makes the model of each cloth.
  State(Scene given, const Options& given_options, const Vec3& about,
        physics::MakeModel make = physics::make_model);

  // frame.cpp
  void advance_frame();

  // interaction.cpp: what a person does.
  void grab(int cloth, int particle, const Vec3& target, double stiffness);
  void release();
  void carry(int cloth, const Vec3& velocity);
  void hold(int cloth, int particle, bool held);
  int cut(const Vec3& a, const Vec3& b, double width);
  void move_collider(int collider, const Vec3& target);
  // A collider has been put where cloths may be.
  void meet(std::size_t collider);

  // state.cpp. Positions are counted from `from`; velocities lie `behind` them by so much [s]. Not given: as
  // those that velocities() tells where they are these, else not at all.
  void set(std::span<const double> positions, const Vec3& from, std::span<const double> velocities,
           std::optional<double> behind = {});

  // snapshot.cpp
  Snapshot snapshot();
  Snapshot told() const;  // without the rest of the run
  // Throws std::invalid_argument for a snapshot that restore() cannot take. (restore() trusts it.)
  void check(const Snapshot& snapshot) const;
  void restore(const Snapshot& snapshot);
  // Whether it may be put back into this state as it has become, and not only into one that has just begun.
  bool takes(const Snapshot& snapshot) const;

  // Adds the notes that wait until somebody reads them.
  void tell_notes() { notes_.tell(cloths, frame, plan.notes); }
  double time() const { return double(frame) * scene.time.frame; }  // s
  // Inverse masses of a cloth, of sleeping particles too.
  const physics::AlignedArray<float>& masses(std::size_t cloth) const {
    return sleeping ? sleeping->masses(cloth) : cloths[cloth]->particles().inverse_mass;
  }
  std::vector<Vec3> velocities(std::size_t cloth) const;  // at the time of the positions
  std::size_t bytes() const;

  physics::PlacedScene placed;
  const Scene& scene = placed.simulated();
  const Options options;
  const Simd simd;
  physics::SubstepRunner runner;
  physics::TimeStep time_step;
  physics::Cloths cloths;
  std::unique_ptr<physics::SheetContact> contact;  // null when self-collision is off in all cloths
  std::unique_ptr<physics::Sleeping> sleeping;     // null when nothing may sleep
  physics::RunTimes times;
  Plan plan;
  Status status;
  std::int64_t frame = 0, total_substeps = 0;
  std::uint64_t changes = 0;  // state set from outside
  // Constraints that the scene's cuts take, of every cloth, pairs of particles.
  std::vector<std::vector<physics::Joined>> cut_from_start;
  // At the end of any frame; none unless it is followed.
  std::optional<double> greatest_strain;

 private:
  const physics::MakeModel make_model_;
  physics::FrameStart start_;
  physics::Hands hands_;
  physics::FrameNotes notes_;
  physics::StepGuard guard_;
  std::shared_ptr<const Scene> kept_scene_;  // of snapshots; null: none was taken
  bool was_driven_ = false;                  // in the frame before
  // As the run began, before any of its frames failed.
  struct Beginning {
    Method method;
    Solver solver;
    int substeps = 1;  // a frame
    bool fallback = false;
    std::vector<std::string> notes;
    physics::EnergyGuard energy;
  } began_;

  // snapshot.cpp
  bool goes_on(const Snapshot& snapshot) const;
  // All that the next frame depends on, but for what a snapshot tells.
  void keep(physics::Keeper& keeper);

  // state.cpp
  void build_cloths();
  Plan describe_stages() const;
  void plan_changed();
  void restart_stages();
  void wake(int cloth = -1);
  bool all_asleep() const { return sleeping && sleeping->all_asleep(); }
  bool driven() const;
  void open_guard();
  void save();
  void put_back();

  // frame.cpp
  void run_frame();
  physics::FrameRun frame_run();
  void end_frame();
  void find_fault();

  // substeps.cpp
  void choose_method_and_substeps();
  int explicit_substeps(std::vector<std::string>& notes);
  void take_substeps(int count);
  bool suit_stages();
  void set_substeps(int count);
  int substeps_within(double limit) const;
  double stretched_limit() const;
  void follow_stretch(double limit);
  bool carry_out(physics::Verdict verdict);
  void change_method(const std::string& which, int count);
  void note_models(std::vector<std::string>& notes) const;
  void begin_again();
  void go_on_as(Method as, const Solver& solver);
  void fall_back(const std::string& where, const std::string& what);

  // interaction.cpp
  physics::ClothStep& step_with(int cloth, int particle);
  void touch(int cloth = -1);
  void set_path(std::size_t collider, std::vector<Key> keys);
};

}  // namespace weft
