// A stage of the step: a piece of the work on one cloth in one substep. Stages are what a step plan
// is made of (frame/cloth_step.h); schedule.h runs them in order.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "weft/scene.h"

namespace weft::physics {

class Keeper;
class Threads;

struct Substep {
  double dt = 0;    // s
  double time = 0;  // s, at the end of the substep
  // s; for how long forces, with methods that project gravity and drag, act on velocities.
  double kick = 0;
  int slot = 0;  // which of a stage's carried buffers this substep uses
  // Whether velocities are right at the start, or only positions and those of the substep before;
  // and whether they are to be right at the end.
  bool velocities_known = true, velocities_wanted = true;
};

// Substeps of one length, one after the other. Velocities lie behind the positions by half of the substep
// before, or by nothing at a start; the first kick takes them to half of the first of these ahead. So the
// position before the first is x(-dt) = x - v dt + a dt²/2, and free fall is exact.
struct Substeps {
  double time = 0;  // s, at the start
  double dt = 0;    // s
  int count = 0;
  double first_kick = 0;  // s; dt where the substep before was as long
  bool velocities_known = true, velocities_wanted = true;  // at the start and at the end
  bool velocities_between = true;                          // or nobody looks at them in between

  Substep at(int n, int slot = 0) const {
    return {dt,
            time + (n + 1) * dt,
            n == 0 ? first_kick : dt,
            slot,
            n == 0 ? velocities_known : velocities_between,
            n + 1 == count ? velocities_wanted : velocities_between};
  }
  // Substep n by itself.
  Substeps only(int n) const {
    const Substep s = at(n);
    return {time + n * dt, dt, 1, s.kick, s.velocities_known, s.velocities_wanted, true};
  }
};

// What a stage has to do with the velocities of particles: it reads or changes them as it moves
// particles; it leaves them alone; or it gives them what the sweeps have brought, which can wait.
enum class Velocities { used, left_alone, from_sweeps };

// Rows begin … end-1.
struct RowSpan {
  int begin = 0, end = 0;
  bool has(int row) const { return row >= begin && row < end; }
};

// What is told of rows as a frame comes to them first, and as it leaves them last.
class RowObserver {
 public:
  virtual ~RowObserver() = default;
  virtual void before(RowSpan rows) = 0;
  virtual void after(RowSpan rows) = 0;
};

class RowStage;
class WholeStage;

// One stage of the plan.
class Stage {
 public:
  Stage(std::string stage_name, std::string stage_detail, std::int64_t touched,
        std::string touched_item)
      : name(std::move(stage_name)),
        detail(std::move(stage_detail)),
        item(std::move(touched_item)),
        items(touched) {}
  virtual ~Stage() = default;
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  // The stage as one of its two kinds; null for the other.
  virtual RowStage* as_row_stage() { return nullptr; }
  virtual WholeStage* as_whole_stage() { return nullptr; }
  // Whether it is the one that takes particles along their velocities; what a person does comes next.
  virtual bool moves_particles() const { return false; }
  // Called before substeps of a new length.
  virtual void prepare(double dt) { (void)dt; }
  virtual Velocities velocities() const { return Velocities::used; }
  // The whole stage at once, for those who look between two stages.
  virtual void run_alone(int rows, const Substep& substep, Threads& threads) = 0;
  // Forgets what it keeps from one substep to the next: the state was set from outside.
  virtual void restart() {}
  // What it keeps from one frame to the next that results depend on is kept, or put back, after restart().
  virtual void keep(Keeper& keeper) { (void)keeper; }
  // The path of this collider has changed.
  virtual void follow(const Collider& collider) { (void)collider; }
  virtual std::size_t bytes() const { return 0; }
  // Share of the rows so far that had nothing to do and were passed over, 0 … 1.
  virtual double idle() const { return 0; }

  const std::string name, detail, item;
  const std::int64_t items;  // touched per substep
};

using Stages = std::vector<std::unique_ptr<Stage>>;

// Works on one row after another: work on row j may read and write rows j … j+reach of the lattice,
// and comes in the order j = 0, 1, 2 … within a substep, unless rows are apart. A stage of more reach may
// carry data from row to row in buffers of its own, one set per slot. It overrides run for one row, or for
// a range of rows.
class RowStage : public Stage {
 public:
  RowStage(std::string stage_name, std::string stage_detail, int rows_reached, std::int64_t touched,
           std::string touched_item)
      : Stage(std::move(stage_name), std::move(stage_detail), touched, std::move(touched_item)),
        reach(rows_reached) {}
  RowStage* as_row_stage() final { return this; }

  virtual void run(int row, const Substep& substep) { run(row, row + 1, substep); }
  virtual void run(int begin, int end, const Substep& substep) {
    for (int j = begin; j < end; ++j) run(j, substep);
  }
  // Whether rows may run in any order and several at once, for no two have a particle in common.
  virtual bool rows_apart() const { return reach == 0; }
  // Called before a row that does not follow on from the row before it, where rows are passed over:
  // what is carried from row to row starts anew.
  virtual void start(const Substep& substep) { (void)substep; }
  // Sees to room for substeps of slots 0 … slots-1.
  void reserve(int slots) {
    if (slots <= slots_) return;
    reserve_slots(slots);
    slots_ = slots;
  }

  void run_alone(int rows, const Substep& substep, Threads&) final {
    reserve(1);
    prepare(substep.dt);
    run(0, rows, substep);
  }

  const int reach;

 protected:
  // Makes room for so many slots in place of what there was.
  virtual void reserve_slots(int slots) { (void)slots; }

 private:
  int slots_ = 0;  // that there is room for
};

// Works on the whole lattice at once, after all that comes before it in the substep and before all
// that follows; shares its work out to the threads itself.
class WholeStage : public Stage {
 public:
  using Stage::Stage;
  WholeStage* as_whole_stage() final { return this; }
  virtual void run(const Substep& substep, Threads& threads) = 0;
  void run_alone(int, const Substep& substep, Threads& threads) final {
    prepare(substep.dt);
    run(substep, threads);
  }
};

}  // namespace weft::physics
