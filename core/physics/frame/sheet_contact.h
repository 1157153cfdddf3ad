// Contact between sheets as it runs beside the substeps: after how many it comes again, and what is taken
// apart first.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <vector>

#include "physics/contact/self/self_contact.h"
#include "physics/contact/self/untangle.h"
#include "physics/frame/cloth_step.h"

namespace weft::physics {

class SheetContact {
 public:
  // Null when self-collision is off in all cloths. What is given lives longer.
  static std::unique_ptr<SheetContact> make(const Scene& scene, const Cloths& cloths,
                                            const KernelTable& kernels);

  // Contact that remembers nothing, in the place of this one.
  void begin_anew();
  // Positions or velocities are others than the last frame left; `look`: sheets may cross.
  void restart();
  void look() { untangle_->look(); }
  // A frame begins, to which go_back() leads: positions alone are what they were then, and what is to come apart.
  void save();
  void go_back();

  void keep(Keeper& keeper);

  // Runs a frame: run_substeps(first, count, part), contact, and so on; where sheets meet first, contact comes
  // between the two parts of the last substep. A frame ends with a run of contact, so that what was put back to a
  // frame's start, or set, begins anew. Intervals are powers of two and begin at multiples of their length: so
  // where frames end matters little.
  template <class RunSubsteps>
  void run_frame(const Substeps& frame, Threads& threads, const RunSubsteps& run_substeps) {
    begin_frame(threads);
    const auto run = [&] {
      for (int s = 0; s < frame.count;) {
        const int count = std::min({until_, s == 0 ? frame.count : s & -s, frame.count - s});
        const int parted = meets_first_ ? 1 : 0;
        if (count > parted) run_substeps(s, count - parted, Schedule::Part::whole);
        s += count;
        if (meets_first_) run_substeps(s - 1, 1, Schedule::Part::first);
        run_contact(frame, s, count, threads);
        if (meets_first_) run_substeps(s - 1, 1, Schedule::Part::second);
      }
    };
    stands_by() ? threads.together(run) : run();
  }

  const SelfContact& pairs() const { return *contact_; }
  // Edges that pass through triangles now, where that may be; else 0.
  std::size_t crossings() { return untangle_->due() ? untangle_->crossings() : 0; }
  SelfContact::Overlaps overlaps() { return contact_->overlaps(); }
  std::int64_t runs() const { return runs_; }
  double milliseconds() const { return double(spent_.count()) * 1e-6; }  // of all runs

 private:
  SheetContact(const Scene& scene, std::vector<ClothModel*> models, const KernelTable& kernels,
               std::unique_ptr<SelfContact> contact, bool meets_first);
  void begin_frame(Threads& threads);
  void run_contact(const Substeps& frame, int end, int count, Threads& threads);
  bool stands_by() const;

  const Scene& scene_;
  const std::vector<ClothModel*> models_;
  const KernelTable& kernels_;
  std::unique_ptr<SelfContact> contact_;
  std::unique_ptr<Untangle> untangle_;
  const bool meets_first_;
  std::vector<std::byte> untangle_at_start_;  // empty: nothing was to come apart
  int until_ = 1;                             // substeps from one run of contact to the next
  std::chrono::nanoseconds spent_{0};
  std::int64_t runs_ = 0;
};

}  // namespace weft::physics
