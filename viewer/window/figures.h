// How quick the window is: for --measure.
#pragma once

#include <string>
#include <vector>

namespace weft::viewer {

struct Turn {
  double all_ms = 0;      // the whole turn, with waiting for the next
  double surface_ms = 0;  // processor time of normals and upload; 0 when there was no new state
  double panel_ms = 0;    // processor time of building and handing over the panel
  bool drawn = false;     // the window was
  bool picture = false;   // the picture was
};

// Turns, pictures, and the window's own work: medians.
std::string words(const std::vector<Turn>& turns);

}  // namespace weft::viewer
