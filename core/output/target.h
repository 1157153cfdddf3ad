// Which file a path means once links are followed.
#pragma once

#include <sys/stat.h>

#include <string>

namespace weft {

struct Target {
  std::string path;    // absolute, without links; the file itself need not exist
  std::string folder;  // its folder
  bool exists = false;
  struct stat status {};  // where it exists
  int descriptor = -1;    // >= 0: the path names what this process has open (/dev/stdout)

  // A file that can be replaced, unlike a device or a pipe, which is written as it is.
  bool replaceable() const { return descriptor < 0 && (!exists || S_ISREG(status.st_mode)); }
};

// A link that leads nowhere means the file that it would lead to. Throws WriteError where there is
// no such folder, or links lead in a circle.
Target find_target(const std::string& path);

}  // namespace weft
