# weft_options: the warnings, floating-point rules and hardening that every target of the project is
# built with.
include(CheckPIESupported)
check_pie_supported(LANGUAGES C CXX)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)  # programs at an address that the system chooses

option(WEFT_HARDENING "Build with what keeps a fault in memory from becoming worse than a stop" ON)

# Headers that most sources include, compiled once for each target with many, and the command and the Python module in
# one piece each: a third less time for a whole build. With a compiler cache each source for itself is faster, and
# shows that it includes what it needs.
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(precompiled OFF)
else()
  set(precompiled ON)
endif()
option(WEFT_PRECOMPILED "Precompile the headers that most sources include" ${precompiled})
set(weft_common_headers <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory>
  <optional> <span> <string> <utility> <variant> <vector>)
# weft_precompile(TARGET HEADER…): those and the common ones.
function(weft_precompile target)
  if(WEFT_PRECOMPILED)
    target_precompile_headers(${target} PRIVATE ${weft_common_headers} ${ARGN})
  endif()
endfunction()

# g++ 12 takes strings in precompiled headers for ones that overflow (its bug 105651), and sources that are built in one
# piece for headers.
set(weft_false_alarms -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread -Wno-subobject-linkage)

add_library(weft_hardening INTERFACE)
add_library(weft_options INTERFACE)
target_link_libraries(weft_options INTERFACE weft_hardening)
target_compile_options(weft_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Werror
  # g++: -Wshadow would also reject constructor parameters named like the member they fill; -Wrestrict
  # warns falsely about std::string in g++ 12.
  $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local> $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  $<$<CXX_COMPILER_ID:Clang>:-Wshadow>
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${WEFT_PRECOMPILED}>>:${weft_false_alarms}>"
  # The same bits from every compiler and instruction set: nothing is fused that the source does not fuse.
  -ffp-contract=off)
if(WEFT_SANITIZE)
  # Null pointers are seen by the address sanitizer too; alignment is what the wide loads need anyway;
  # both checks at every access would double the time of the build. g++ gives more false warnings here.
  target_compile_options(weft_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-error> -fsanitize=${WEFT_SANITIZE}
    -fno-sanitize=null,alignment,vptr -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(weft_options INTERFACE -fsanitize=${WEFT_SANITIZE})
elseif(WEFT_HARDENING)
  # What keeps a fault from becoming worse than a stop: canaries on the stack and no jump over its
  # guard page, checked sizes in the C library (which need an optimised build), indirect calls that
  # land on entries only, tables of the linker that are read-only once the program runs. The address
  # sanitizer replaces some of these and forbids others. tests/hardening_test looks for them. They
  # cost 0.2 % more instructions of a run.
  target_compile_options(weft_hardening INTERFACE
    -fstack-protector-strong -fstack-clash-protection -fcf-protection=full
    $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE> $<$<NOT:$<CONFIG:Debug>>:-D_FORTIFY_SOURCE=3>)
  target_link_options(weft_hardening INTERFACE LINKER:-z,relro LINKER:-z,now)
endif()
# Every index into the standard library's containers is checked where speed does not matter.
# (The names of sanitizers hold commas, which a generator expression takes for the next parameter.)
if(WEFT_SANITIZE)
  target_compile_definitions(weft_options INTERFACE _GLIBCXX_ASSERTIONS)
else()
  target_compile_definitions(weft_options INTERFACE $<$<CONFIG:Debug>:_GLIBCXX_ASSERTIONS>)
endif()
