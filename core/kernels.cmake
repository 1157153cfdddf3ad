# Every kernel source is built once for each instruction set; the step plan picks one at run time
# (physics/kernels/kernels.h). The scalar build keeps the compiler from vectorising on its own, so
# that it is an honest reference. A collider's file holds its kernel and the rest of it; shapes.cpp and
# simd.cpp hold no kernels.
file(GLOB kernel_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/physics/kernels/*.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/physics/contact/colliders/*.cpp)
list(FILTER kernel_sources EXCLUDE REGEX "/(shapes|simd).cpp$")
set(flags_scalar -DWEFT_LANES=1 -fno-tree-vectorize)
set(flags_sse2 -DWEFT_LANES=4)
set(flags_avx2 -DWEFT_LANES=8 -mavx2 -mfma)
set(flags_avx512 -DWEFT_LANES=16 -mavx512f -mavx512vl -mavx512dq -mavx512bw -mprefer-vector-width=512)
set(WEFT_SIMD_SETS "scalar;sse2;avx2;avx512" CACHE STRING "Instruction sets that there are kernels for")
if(NOT "scalar" IN_LIST WEFT_SIMD_SETS AND NOT "sse2" IN_LIST WEFT_SIMD_SETS)
  message(FATAL_ERROR "WEFT_SIMD_SETS is \"${WEFT_SIMD_SETS}\": scalar or sse2 must be among them, which every machine runs")
endif()
set(sets "")
foreach(simd ${WEFT_SIMD_SETS})
  if(NOT DEFINED flags_${simd})
    message(FATAL_ERROR "WEFT_SIMD_SETS has \"${simd}\" (allowed: scalar, sse2, avx2, avx512)")
  endif()
  string(APPEND sets "WEFT_SET(${simd}) ")
  add_library(weft_kernels_${simd} OBJECT ${kernel_sources})
  set_target_properties(weft_kernels_${simd} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_include_directories(weft_kernels_${simd} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}
    ${CMAKE_CURRENT_SOURCE_DIR}/include)
  target_compile_definitions(weft_kernels_${simd} PRIVATE WEFT_SIMD=${simd})
  # -Wno-psabi: wide values are passed inside one instruction set only, never across.
  target_compile_options(weft_kernels_${simd} PRIVATE ${flags_${simd}} -fno-math-errno
    -fno-trapping-math -falign-functions=64 -Wno-psabi)
  target_link_libraries(weft_kernels_${simd} PRIVATE weft_options)
  weft_precompile(weft_kernels_${simd} <physics/kernels/row_kernels.h>)
  target_sources(weft_core PRIVATE $<TARGET_OBJECTS:weft_kernels_${simd}>)
endforeach()
set_source_files_properties(physics/kernels/simd.cpp PROPERTIES COMPILE_DEFINITIONS "WEFT_SETS=${sets}")
# With sanitizers kernels would take most of the build. Multiply-adds that no instruction does are calls, and so are the
# checks of memory in large functions. Pointers that overflow, or leave their object, are seen by the address sanitizer
# where something is read or written there.
add_library(weft_kernel_checks INTERFACE)
if(WEFT_SANITIZE)
  target_compile_definitions(weft_kernel_checks INTERFACE WEFT_FMA_IS_CALLED)
  target_compile_options(weft_kernel_checks INTERFACE -fno-sanitize=pointer-overflow,object-size)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(weft_kernel_checks INTERFACE "SHELL:--param asan-instrumentation-with-call-threshold=200")
  endif()
endif()
foreach(simd ${WEFT_SIMD_SETS})
  target_link_libraries(weft_kernels_${simd} PRIVATE weft_kernel_checks)
endforeach()
