// Instruction sets.
#pragma once

namespace weft {

// Instruction sets that kernels are built for; `best` is the widest that this build has and this machine runs.
enum class Simd { scalar, sse2, avx2, avx512, best };

// The name of an instruction set as reports and --simd write it.
const char* simd_name(Simd simd);

// Whether this build has kernels for it and this machine can run them (`best`: always).
bool simd_available(Simd simd);

}  // namespace weft
