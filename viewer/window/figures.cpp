// Medians and rates.
#include "window/figures.h"

#include <algorithm>
#include <cstdio>

namespace weft::viewer {

namespace {

template <class Value>
double quantile(const std::vector<Turn>& turns, double share, Value value) {
  std::vector<double> all;
  for (const Turn& turn : turns)
    if (value(turn) > 0) all.push_back(value(turn));
  if (all.empty()) return 0;
  std::sort(all.begin(), all.end());
  return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
}

}  // namespace

std::string words(const std::vector<Turn>& turns) {
  double seconds = 1e-9, pictures = 0, drawn = 0;
  for (const Turn& turn : turns) {
    seconds += 1e-3 * turn.all_ms;
    pictures += turn.picture ? 1 : 0;
    drawn += turn.drawn ? 1 : 0;
  }
  const auto all = [](const Turn& t) { return t.all_ms; };
  const auto surface = [](const Turn& t) { return t.surface_ms; };
  const auto panel = [](const Turn& t) { return t.panel_ms; };
  char text[400];
  std::snprintf(text, sizeof text,
                "turns %.1f/s (median %.1f ms, 95 %% within %.1f ms), panel %.1f/s\n"
                "pictures %.1f/s\n"
                "processor time a turn: normals and upload %.2f ms, panel %.2f ms (medians)\n",
                static_cast<double>(turns.size()) / seconds, quantile(turns, 0.5, all),
                quantile(turns, 0.95, all), drawn / seconds, pictures / seconds,
                quantile(turns, 0.5, surface), quantile(turns, 0.5, panel));
  return text;
}

}  // namespace weft::viewer
