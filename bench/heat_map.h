// Heat maps of fates (stress_case.h) as small multiples: one panel a solver, all over the same axes.
#pragma once

#include <string>
#include <vector>

#include "stress_case.h"

namespace bench {

struct Ticks {
  std::string label;
  std::vector<std::string> ticks;  // one for each column or row of cells
};

// A place on the map worth naming: fractions of cells, counted from the first cell's center.
struct Mark {
  double column = 0, row = 0;
  std::string text;
};

struct Panel {
  std::string name;
  std::vector<Fate> cells;  // row after row, as many as the ticks of both axes multiply to
};

struct HeatMap {
  std::string title, subtitle;
  Ticks across, up;
  std::vector<Panel> panels;
  std::vector<Mark> marks;  // on every panel, numbered, explained below
};

std::string to_svg(const HeatMap& map);

// Writes PATH.svg; throws std::runtime_error when it cannot.
void write_heat_map(const std::string& path, const HeatMap& map);

}  // namespace bench
