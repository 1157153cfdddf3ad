// The stages of a cloth as they are chosen: those that run, in order, and those that the scene does
// without, with the reason.
#pragma once

#include "physics/step/stage.h"
#include "weft/report.h"

namespace weft::physics {

struct StageList {
  Stages stages;
  std::vector<SkippedStage> skipped;

  // Appends a stage or, where there is none, tells why.
  void choose(const char* name, std::unique_ptr<Stage> stage, const char* why_not) {
    if (stage)
      stages.push_back(std::move(stage));
    else
      skip(name, why_not);
  }
  void skip(const char* name, const char* why_not) { skipped.push_back({name, why_not}); }
};

}  // namespace weft::physics
