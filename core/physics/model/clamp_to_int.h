// Conversion of a floating-point number to a whole one without undefined behaviour.
#pragma once

namespace weft::physics {

// `value` cut to least … greatest and rounded towards zero; what is not a number becomes `least`.
inline int clamp_to_int(double value, int least, int greatest) {
  if (!(value > least)) return least;
  return value < greatest ? int(value) : greatest;
}

}  // namespace weft::physics
