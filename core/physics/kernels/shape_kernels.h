// The kernels of every shape of a collider, of this instruction set: each shape's own file defines its own, the table
// collects them.
#pragma once

#include "physics/kernels/colliders.h"
#include "physics/kernels/wide.h"

namespace weft::WEFT_KERNELS {

#define WEFT_DECLARE(Type, name) extern const physics::ColliderKernels k##Type;
WEFT_SHAPES(WEFT_DECLARE)
#undef WEFT_DECLARE

}  // namespace weft::WEFT_KERNELS
