// The one format of error lines.
#include "failure.h"

#include <iostream>

#include "weft/printable.h"

namespace weft::cli {

void print(const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) {
    std::cerr << "weft: error: " << printable(fault.place) << ": " << printable(fault.what);
    if (!fault.allowed.empty()) std::cerr << " (" << printable(fault.allowed) << ")";
    std::cerr << "\n";
  }
}

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace weft::cli
