// Numbers in notes and messages.
#pragma once

#include <cstdio>
#include <string>

namespace weft {

// A number as notes give it.
inline std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", v);
  return text;
}

}  // namespace weft
