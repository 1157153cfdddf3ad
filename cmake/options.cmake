# weft_options: the warnings and floating-point rules that every target of the project is built with.
add_library(weft_options INTERFACE)
target_compile_options(weft_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Werror
  # g++: -Wshadow would also reject constructor parameters named like the member they fill; -Wrestrict
  # warns falsely about std::string in g++ 12.
  $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local> $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  $<$<CXX_COMPILER_ID:Clang>:-Wshadow>
  # The same bits from every compiler and instruction set: nothing is fused that the source does not fuse.
  -ffp-contract=off)
if(WEFT_SANITIZE)
  # Null pointers are seen by the address sanitizer too; alignment is what the wide loads need anyway;
  # both checks at every access would double the time of the build.
  target_compile_options(weft_options INTERFACE -fsanitize=${WEFT_SANITIZE}
    -fno-sanitize=null,alignment,vptr -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(weft_options INTERFACE -fsanitize=${WEFT_SANITIZE})
endif()
