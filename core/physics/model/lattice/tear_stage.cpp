// Stage "tear": constraints beyond their tear strain end.
#include <utility>

#include "physics/kernels/lattice.h"
#include "physics/model/lattice/stages.h"
#include "physics/model/lattice/tearing.h"

namespace weft::physics {
namespace {

// Where the springs say which rows had a constraint too long at the start of the substep, the others
// need no look. What sweeps have ended is counted.
class TearStage final : public RowStage {
 public:
  TearStage(const LatticeParts& parts, LatticeTearing& tearing)
      : RowStage("tear", "constraints beyond their tear strain end", greatest_reach(parts),
                 parts.constraints(), "constraints"),
        parts_(parts),
        tearing_(tearing) {}
  void run(int j, const Substep&) override {
    if (parts_.ended) {
      if (parts_.ended[j] > 0) tearing_.died(j, std::exchange(parts_.ended[j], 0));
      return;
    }
    if (parts_.overlong && !parts_.overlong[j]) return;
    Lattice& l = parts_.lattice;
    for (const Stencil& f : parts_.stencils) {
      if (j + f.dj >= l.rows) continue;
      const int torn =
          parts_.kernels.lattice.tear({f.per_row(l.columns), ends_of(f, l.x, j), nullptr,
                                       f.links->row(j), tear_length(parts_.cloth, f)});
      if (torn > 0) tearing_.died(j, torn);
    }
  }

 private:
  LatticeParts parts_;
  LatticeTearing& tearing_;
};

}  // namespace

std::unique_ptr<RowStage> make_tear(const LatticeParts& parts, LatticeTearing& tearing) {
  return std::make_unique<TearStage>(parts, tearing);
}

}  // namespace weft::physics
