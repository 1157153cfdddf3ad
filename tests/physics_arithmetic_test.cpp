// Arithmetic four lanes wide, without instructions for it.
#define WEFT_LANES 4
#define WEFT_SIMD sse2
#include "arithmetic.h"
