// Sweeps over many cases have a short form: ctest runs it, and the whole where WEFT_FULL is set in the environment.
#pragma once
#include <cstdlib>

namespace weft {

// Whether all is run.
inline bool whole_sweeps() {
  return std::getenv("WEFT_FULL") != nullptr;
}

class Cases {
 public:
  // The short form is one case in `every`. A number without a factor in common with the lengths of the loops about it
  // meets every value of each.
  explicit Cases(int every) : every_(whole_sweeps() ? 1 : every) {}

  // Whether to run the next case.
  bool next() { return count_++ % every_ == 0; }

 private:
  int every_, count_ = 0;
};

}  // namespace weft
