// The commands of `weft`, one file each. A new command adds its file, a line here and one in main.
#pragma once

#include <CLI/CLI.hpp>

namespace weft::cli {

// Each adds its command to the program; when the command line names it, it runs and leaves its exit
// code, or throws a Failure (failure.h).
void add_run(CLI::App& program, int& exit_code);
void add_check(CLI::App& program, int& exit_code);
void add_explain(CLI::App& program, int& exit_code);
void add_scenes(CLI::App& program, int& exit_code);
void add_study(CLI::App& program, int& exit_code);  // where HDF5 is found
void add_view(CLI::App& program, int& exit_code);

}  // namespace weft::cli
