// `weft view SCENE`: becomes weft-viewer, the window, which is a program of its own so that this
// one needs no graphics library.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "commands.h"
#include "failure.h"

namespace weft::cli {

namespace {

namespace fs = std::filesystem;

// Beside this program as installed, or where the build puts it.
fs::path find_viewer() {
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& place : {here, here.parent_path() / "viewer"}) {
    fs::path viewer = place / "weft-viewer";
    if (!here.empty() && ::access(viewer.c_str(), X_OK) == 0) return viewer;
  }
  throw Failure{kBadCommandLine,
                {{"view", "weft-viewer is not installed beside weft",
                  "it is built where the viewer's packages are found; `weft run` needs none"}}};
}

int view(std::vector<std::string> arguments) {
  const fs::path viewer = find_viewer();
  arguments.insert(arguments.begin(), viewer.string());
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv(viewer.c_str(), pointers.data());
  throw Failure{kBadCommandLine, {{viewer.string(), std::strerror(errno), ""}}};
}

}  // namespace

void add_view(CLI::App& program, int& exit_code) {
  CLI::App* command = program.add_subcommand(
      "view", "Open a scene in the window: weft view [SCENE] [options of weft-viewer]");
  command->prefix_command();
  command->callback([command, &exit_code] { exit_code = view(command->remaining()); });
}

}  // namespace weft::cli
