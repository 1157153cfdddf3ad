// Arithmetic one by one.
#define WEFT_LANES 1
#define WEFT_SIMD scalar
#include "arithmetic.h"
