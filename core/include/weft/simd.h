// Instruction sets.
#pragma once

namespace weft {

// Instruction sets that the kernels are built for; `best` is the widest this machine runs.
enum class Simd { scalar, sse2, avx2, avx512, best };

// The name of an instruction set as reports and --simd write it.
const char* simd_name(Simd simd);

// Whether this machine can run it (`best`: always).
bool simd_available(Simd simd);

}  // namespace weft
