// Runs the real `weft` as a person would, from a folder of the test's own.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "folder.h"

namespace weft {

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

// `arguments` go through the shell; `before` comes before the program (variables, timeout).
inline Outcome run_weft(const Folder& folder, const std::string& arguments,
                        const std::string& before = "") {
  const Folder::Captured captured = folder.capture();
  const std::string command = "cd '" + folder.path() + "' && " + before + " '" WEFT_PROGRAM "' " +
                              arguments + " >'" + captured.out + "' 2>'" + captured.err + "'";
  const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe)
  Outcome outcome;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  outcome.out = Folder::take(captured.out);
  outcome.err = Folder::take(captured.err);
  return outcome;
}

// A small scene that any machine runs in an instant.
inline std::string small_scene(const Folder& folder) {
  return folder.write("small.json", R"({
    "weft": 1, "name": "small",
    "time": {"frame": 0.02, "substeps": 10},
    "cloths": [{"grid": {"points": [8, 6], "u": [1, 0, 0], "v": [0, 0, 1]}, "pins": [[0, 0], [7, 0]]}]
  })");
}

}  // namespace weft
