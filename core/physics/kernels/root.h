// Reciprocal square roots without the divider: a guess from the exponent's bits and one step of fifth
// order. With y the guess and e = 1 - s y² what it is off by,
//
//   1/√s = y (1 - e)^(-1/2) ≈ y (1 + c1 e + c2 e² + c3 e³ + c4 e⁴),   -0.0691 <= e <= 0.0676,
//
// the coefficients being those of the least greatest relative error, 2.3e-8 (Remez). The result is
// within 1.32 units in the last place; one over a root is within 1.5. It takes half the time of those
// or less, and is the same bits everywhere, which the processors' own estimates are not.
//
// The guess halves the exponent (and so nearly the logarithm) by a shift; the magic number is the
// widely known one of Quake III's source.
#pragma once

#include "physics/kernels/wide.h"

namespace weft::WEFT_KERNELS {

// The steps one by one, for kernels that let several roots go on side by side.
class ReciprocalRoot {
 public:
  // s > 0 and finite; of 0 the result is finite and large.
  WEFT_INLINE void guess(Wide s) {
    guess_ = (Wide)(0x5f3759df - ((WideInt)s >> 1));
    e_ = fnma(s * guess_, guess_, wide(1));
  }
  WEFT_INLINE void refine() {
    series_ = fma(fma(wide(0.27406928f), e_, wide(0.31393923f)), e_, wide(0.37500059f));
  }
  WEFT_INLINE Wide result() const {
    return fma(guess_ * e_, fma(series_, e_, wide(0.49999832f)), guess_);
  }

 private:
  Wide guess_, e_, series_;
};

WEFT_INLINE Wide reciprocal_root(Wide s) {
  ReciprocalRoot r;
  r.guess(s);
  r.refine();
  return r.result();
}

// |e|², but not zero: two coincident particles have no direction, and e times whatever comes of their
// distance is zero.
WEFT_INLINE Wide squared_length(Wide3 e) {
  return fma(e.z, e.z, fma(e.y, e.y, fma(e.x, e.x, wide(1e-30f))));
}

}  // namespace weft::WEFT_KERNELS
