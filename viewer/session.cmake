# weft_session: what the viewer does to runs and documents, without a window. The viewer and tests link it.
find_package(nlohmann_json REQUIRED)
file(GLOB session_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/run/*.cpp ${CMAKE_CURRENT_LIST_DIR}/edit/*.cpp)
add_library(weft_session STATIC EXCLUDE_FROM_ALL ${session_sources} ${CMAKE_CURRENT_LIST_DIR}/picture/frame_data.cpp)
# Private headers of the library: the schema's table of parameters.
target_include_directories(weft_session PUBLIC ${CMAKE_CURRENT_LIST_DIR} ${PROJECT_SOURCE_DIR}/core)
target_link_libraries(weft_session PUBLIC weft_core PRIVATE weft_options nlohmann_json::nlohmann_json)
target_compile_options(weft_session PRIVATE -fno-math-errno)  # square roots of whole rows at once
weft_precompile(weft_session <weft/simulation.h>)
