// The step plan as text, as `weft explain` prints it.
#include <algorithm>
#include <array>
#include <cstdio>

#include "weft/report.h"

namespace weft {

namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text;
}

std::string right(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

std::string items(const PlannedStage& stage) {
  return std::to_string(stage.items) + " " + stage.item;
}

std::string stages_text(const std::vector<PlannedStage>& stages) {
  std::size_t name_width = 5;
  std::size_t item_width = 5;
  for (const PlannedStage& stage : stages) {
    name_width = std::max(name_width, stage.name.size());
    item_width = std::max(item_width, items(stage).size());
  }
  std::string text = "     " + padded("stage", name_width) + "  times a frame  " +
                     padded("items", item_width) + "  what\n";
  int order = 0;
  for (const PlannedStage& stage : stages) {
    text += right(std::to_string(++order), 3) + "  " + padded(stage.name, name_width) + "  " +
            right(number(stage.calls_per_frame), 13) + "  ";
    text += stage.detail.empty() ? items(stage) : padded(items(stage), item_width) + "  ";
    text += stage.detail + "\n";
  }
  return text;
}

std::string skipped_text(const std::vector<SkippedStage>& skipped) {
  std::size_t width = 0;
  for (const SkippedStage& stage : skipped) width = std::max(width, stage.name.size());
  std::string text;
  for (const SkippedStage& stage : skipped) {
    text += "     " + padded(stage.name, width) + "  " + stage.why + "\n";
  }
  return text;
}

}  // namespace

std::string to_text(const Plan& plan) {
  std::string text =
      std::to_string(plan.substeps) + " substeps a frame of " + number(plan.dt * 1e3) + " ms";
  if (plan.dt_limit > 0) text += " (stable below " + number(plan.dt_limit * 1e3) + " ms)";
  text += "\n\nruns, in this order:\n" + stages_text(plan.stages);
  if (!plan.skipped.empty()) text += "\nleft out:\n" + skipped_text(plan.skipped);
  if (!plan.notes.empty()) text += "\nnotes:\n";
  for (const std::string& note : plan.notes) text += "     " + note + "\n";
  return text;
}

}  // namespace weft
