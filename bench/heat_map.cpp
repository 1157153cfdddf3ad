// Draws heat maps (heat_map.h).
#include "heat_map.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace bench {
namespace {

constexpr int kAcross = 4;               // panels
constexpr double kLeft = 62, kTop = 96;  // of the first panel's cells [px]
constexpr double kRight = 16;            // for names longer than their panel
constexpr double kCell = 15, kGap = 38, kHead = 30;
constexpr double kLeastPitch = 178;  // from panel to panel: room for their names
const char* const kColours[kFates] = {"#2f9e6e", "#8cc7e8", "#c8cdd6", "#f2a03d", "#c2352b"};
const char* const kMeanings[kFates] = {"stable", "stable by another way than asked",
                                       "refused before it runs", "out of bounds", "not finite"};

struct Layout {
  std::size_t columns, rows;
  double width() const { return double(columns) * kCell; }
  double height() const { return double(rows) * kCell; }
  double pitch() const { return std::max(width() + kGap, kLeastPitch); }
  double x(std::size_t panel) const { return kLeft + double(panel % kAcross) * pitch(); }
  double y(std::size_t panel) const {
    return kTop + double(panel / kAcross) * (height() + kGap + kHead);
  }
};

void text(std::ostream& out, double x, double y, const std::string& words,
          const std::string& more = "") {
  out << "<text x=\"" << x << "\" y=\"" << y << "\" " << more << ">" << words << "</text>\n";
}

void cells(std::ostream& out, const HeatMap& map, const Layout& at, std::size_t n) {
  const Panel& panel = map.panels[n];
  text(out, at.x(n), at.y(n) - 7, panel.name, "font-weight=\"600\" font-size=\"11\"");
  for (std::size_t r = 0; r < at.rows; ++r)
    for (std::size_t c = 0; c < at.columns; ++c)
      out << "<rect x=\"" << at.x(n) + double(c) * kCell << "\" y=\""
          << at.y(n) + double(at.rows - 1 - r) * kCell << "\" width=\"" << kCell - 1
          << "\" height=\"" << kCell - 1 << "\" fill=\""
          << kColours[int(panel.cells[r * at.columns + c])] << "\"/>\n";
  for (std::size_t m = 0; m < map.marks.size(); ++m) {
    const double x = at.x(n) + (map.marks[m].column + 0.5) * kCell;
    const double y = at.y(n) + (double(at.rows) - 0.5 - map.marks[m].row) * kCell;
    out << "<circle cx=\"" << x << "\" cy=\"" << y
        << "\" r=\"6.5\" fill=\"#fff\" stroke=\"#1d2430\"/>\n";
    text(out, x, y + 3.2, std::to_string(m + 1), "text-anchor=\"middle\" font-size=\"9\"");
  }
}

void ticks(std::ostream& out, const HeatMap& map, const Layout& at, std::size_t n) {
  if (n % kAcross == 0)
    for (std::size_t r = 0; r < at.rows; ++r)
      text(out, at.x(n) - 5, at.y(n) + (double(at.rows - 1 - r) + 0.7) * kCell, map.up.ticks[r],
           "text-anchor=\"end\" font-size=\"9\"");
  if (n + kAcross < map.panels.size()) return;
  for (std::size_t c = 0; c < at.columns; ++c) {
    std::ostringstream turn;
    const double x = at.x(n) + (double(c) + 0.7) * kCell, y = at.y(n) + at.height() + 6;
    turn << "text-anchor=\"end\" font-size=\"9\" transform=\"rotate(-60 " << x << ' ' << y << ")\"";
    text(out, x, y, map.across.ticks[c], turn.str());
  }
}

void legend(std::ostream& out, const HeatMap& map, double y) {
  std::set<Fate> used;
  for (const Panel& p : map.panels) used.insert(p.cells.begin(), p.cells.end());
  double x = kLeft;
  for (const Fate fate : used) {
    out << "<rect x=\"" << x << "\" y=\"" << y - 11 << "\" width=\"13\" height=\"13\" fill=\""
        << kColours[int(fate)] << "\"/>\n";
    text(out, x + 19, y, kMeanings[int(fate)]);
    x += 44 + 6.2 * double(std::string(kMeanings[int(fate)]).size());
  }
  for (std::size_t m = 0; m < map.marks.size(); ++m)
    text(out, kLeft, y + 22 + 17 * double(m), std::to_string(m + 1) + "  " + map.marks[m].text);
}

}  // namespace

std::string to_svg(const HeatMap& map) {
  const Layout at{map.across.ticks.size(), map.up.ticks.size()};
  const std::size_t last = map.panels.size() - 1;
  const double width = kLeft + kAcross * at.pitch() + kRight;
  const double bottom = at.y(last) + at.height() + 58;
  const double height = bottom + 40 + 17 * double(map.marks.size());
  std::ostringstream out;
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width << ' ' << height
      << "\" font-family=\"Inter, 'Helvetica Neue', Arial, sans-serif\" font-size=\"11.5\" "
         "fill=\"#1d2430\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  text(out, kLeft, 30, map.title, "font-size=\"18\" font-weight=\"700\"");
  text(out, kLeft, 50, map.subtitle, "fill=\"#5b6472\"");
  for (std::size_t n = 0; n < map.panels.size(); ++n) {
    cells(out, map, at, n);
    ticks(out, map, at, n);
  }
  text(out, kLeft, kTop - 24, "↑ " + map.up.label + "   → " + map.across.label,
       "fill=\"#5b6472\" font-style=\"italic\"");
  legend(out, map, bottom + 14);
  out << "</svg>\n";
  return out.str();
}

void write_heat_map(const std::string& path, const HeatMap& map) {
  std::ofstream out(path + ".svg");
  if (!(out << to_svg(map)) || !out.flush())
    throw std::runtime_error("cannot write " + path + ".svg");
}

}  // namespace bench
