# What `cmake --install` gives: the program, the headers, the library with its kernels inside, and
# the package by which find_package(weft CONFIG) finds weft::core. (Scenes and schema: assets.cmake.)
include(CMakePackageConfigHelpers)

set(weft_package ${CMAKE_INSTALL_LIBDIR}/cmake/weft)
install(TARGETS weft_core EXPORT weftTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/weft DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT weftTargets NAMESPACE weft:: DESTINATION ${weft_package})

# The library is static: whoever links it links what it uses inside, oneTBB, but sees none of it.
file(CONFIGURE OUTPUT weftConfig.cmake @ONLY CONTENT [[
include(CMakeFindDependencyMacro)
find_dependency(TBB)
include("${CMAKE_CURRENT_LIST_DIR}/weftTargets.cmake")
]])
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/weftConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/weftConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/weftConfigVersion.cmake DESTINATION ${weft_package})

install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR})
