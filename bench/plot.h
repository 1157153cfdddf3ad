// Work-precision diagrams: wall time across, error upwards, both logarithmic, one colour a method.
#pragma once

#include <string>
#include <vector>

namespace bench {

struct PlotPoint {
  double x = 0, y = 0;
  std::string label;  // shown on hovering
};

// One method: all its points as dots; those that no other of its points beats joined by a line.
struct PlotSeries {
  std::string name;
  std::vector<PlotPoint> points;
};

struct Plot {
  std::string title, subtitle, x_label, y_label;
  std::vector<PlotSeries> series;
  double target_x = 0, target_y = 0;  // a corner to stay inside; 0 = none
};

// The diagram as SVG. It carries its own background and needs no fonts but the reader's.
std::string to_svg(const Plot& plot);

// Writes PATH.svg, and PATH.png where rsvg-convert is installed; throws std::runtime_error when the
// SVG cannot be written.
void write_plot(const std::string& path, const Plot& plot);

}  // namespace bench
