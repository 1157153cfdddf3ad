// The maps of the stability stress: which settings are run, over which axes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "heat_map.h"

namespace bench {

// A map before it is run: the cases of every panel and cell; a cell is as bad as its worst case.
struct MapPlan {
  std::string name;  // of its file
  HeatMap map;       // panels without cells
  struct Cell {
    std::size_t panel = 0, cell = 0;
    bool course = false;  // by the course-style solver
    std::vector<StressCase> cases;
  };
  std::vector<Cell> cells;
};

// All maps; `quick` leaves out most columns and rows.
std::vector<MapPlan> plan_maps(bool quick);

// The explosions that the seeds tell of, one by one.
struct Told {
  std::string text;
  StressCase setting;
};
std::vector<Told> told_explosions();

}  // namespace bench
