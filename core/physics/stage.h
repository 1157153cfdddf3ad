// A stage of the step: work on the rows of one cloth, one row after another. Stages are the pieces
// that a step plan is made of (plan.h); the wavefront (wavefront.h) runs them.
#pragma once

#include <cstdint>
#include <string>

namespace weft::physics {

struct Substep {
  double dt = 0;            // s
  double time = 0;          // s, at the end of the substep
  int slot = 0;             // which of a stage's carried buffers this substep uses
};

// run(j) may read and write rows j … j+reach of the lattice, and must be called for j = 0, 1, 2 …
// It may carry data from row to row in buffers of its own, one set per slot.
class RowStage {
 public:
  RowStage(std::string name, std::string detail, int reach, std::int64_t items, std::string item)
      : name(std::move(name)),
        detail(std::move(detail)),
        item(std::move(item)),
        items(items),
        reach(reach) {}
  virtual ~RowStage() = default;
  RowStage(const RowStage&) = delete;
  RowStage& operator=(const RowStage&) = delete;

  virtual void run(int row, const Substep& substep) = 0;
  // Makes room for substeps of slots 0 … slots-1.
  virtual void reserve_slots(int slots) { (void)slots; }
  virtual std::size_t bytes() const { return 0; }
  // Share of the rows so far that had nothing to do and were passed over, 0 … 1.
  virtual double idle() const { return 0; }

  const std::string name, detail, item;
  const std::int64_t items;  // touched per substep
  const int reach;
};

}  // namespace weft::physics
