// How many times finer automatic substeps are while strain limits do not hold in those that are due: where bodies or
// other sheets press a cloth harder than the sweeps of its limit can balance in one substep.
//
// A frame whose limits do not hold is run again with twice the substeps, and those after it have as many. What finer
// substeps do not cure, as where pins are drawn apart, gets none for a while. Once limits have held for some
// frames, substeps are longer again.
#pragma once

#include "physics/frame/cloth_step.h"
#include "physics/frame/sleeping.h"

namespace weft::physics {

class LimitGuard {
 public:
  // Whether a frame with automatic substeps is to be run again with twice as many.
  bool asks_again(const Cloths& cloths, const Sleeping* sleeping);
  // The frame stands. Returns whether those after it have half as many substeps.
  bool accept();
  int finer() const { return finer_; }
  void begin_anew() { *this = {}; }

 private:
  int finer_ = 1;
  bool again_ = false;  // this frame has been run before, in coarser substeps, with
  double before_ = 0;   // so much strain beyond a limit, of the limit
  double excess_ = 0;   // the same, of the run looked at
  int held_ = 0;        // frames since limits did not hold
  int hopeless_ = 0;    // frames in which no finer substeps are tried
};

}  // namespace weft::physics
