// Draws work-precision diagrams as SVG (plot.h).
#include "plot.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace bench {
namespace {

// Page and drawing area [px].
constexpr double kWidth = 900, kHeight = 520, kLeft = 84, kRight = 636, kTop = 84, kBottom = 452;

// Told apart by people of any colour vision (after Okabe and Ito), darkened for thin lines on
// white.
constexpr std::array<const char*, 10> kColours{"#0b6e4f", "#d1495b", "#2f6fde", "#e08e00",
                                               "#7b4bb3", "#0092a8", "#8a5a2b", "#5b6472",
                                               "#c03a9b", "#6a8f00"};
constexpr const char* kInk = "#1d2430";
constexpr const char* kFaint = "#8a93a3";

std::string escaped(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string fixed(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", v);
  return text;
}

// A logarithmic axis from one round value to another, mapped onto pixels.
class Axis {
 public:
  Axis(double least, double most, double from, double to) : from_(from), to_(to) {
    // Out to the next value of 1, 2, 5 x 10ⁿ, so that no point lies on the frame.
    low_ = std::log10(round_value(least * 0.85, false));
    high_ = std::log10(round_value(most * 1.15, true));
  }
  double at(double v) const {
    return from_ + (to_ - from_) * (std::log10(v) - low_) / (high_ - low_);
  }
  bool holds(double v) const { return std::log10(v) > low_ - 1e-9 && std::log10(v) < high_ + 1e-9; }
  int first_decade() const { return int(std::floor(low_)); }
  int last_decade() const { return int(std::ceil(high_)); }

 private:
  static double round_value(double v, bool up) {
    const double decade = std::pow(10, std::floor(std::log10(v)));
    double below = decade;
    for (double step : {1.0, 2.0, 5.0, 10.0}) {
      if (up && decade * step >= v) return decade * step;
      if (!up && decade * step <= v) below = decade * step;
    }
    return below;
  }
  double from_, to_, low_, high_;
};

struct Extent {
  double x0 = 1e300, x1 = 0, y0 = 1e300, y1 = 0;
  void add(double x, double y) {
    x0 = std::min(x0, x), x1 = std::max(x1, x);
    y0 = std::min(y0, y), y1 = std::max(y1, y);
  }
};

Extent extent_of(const Plot& plot) {
  Extent e;
  for (const PlotSeries& s : plot.series)
    for (const PlotPoint& p : s.points) e.add(p.x, p.y);
  if (plot.target_x > 0) e.add(plot.target_x, plot.target_y);
  return e;
}

// The points that no other of the same list beats in both, from fast to slow; a twentieth less
// error is no reason to be slower.
std::vector<PlotPoint> front_of(std::vector<PlotPoint> points) {
  std::sort(points.begin(), points.end(), [](const PlotPoint& a, const PlotPoint& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  std::vector<PlotPoint> front;
  for (PlotPoint& p : points)
    if (front.empty() || p.y < 0.95 * front.back().y) front.push_back(std::move(p));
  return front;
}

// The value of a decade: plain where it is short, else as a power of ten.
std::string decade_text(int decade) {
  char text[96];
  if (decade >= -3 && decade <= 3)
    std::snprintf(text, sizeof text, "%g", std::pow(10, decade));
  else
    std::snprintf(text, sizeof text, "10<tspan dy=\"-5\" font-size=\"9\">%s%d</tspan>",
                  decade < 0 ? "−" : "", std::abs(decade));
  return text;
}

void grid(std::ostream& out, const Axis& x, const Axis& y) {
  const auto line = [&](double x0, double y0, double x1, double y1, bool major) {
    out << "<path d=\"M" << fixed(x0) << ' ' << fixed(y0) << 'L' << fixed(x1) << ' ' << fixed(y1)
        << "\" stroke=\"" << (major ? "#d5dae2" : "#eef1f5") << "\"/>\n";
  };
  for (int d = x.first_decade(); d <= x.last_decade(); ++d)
    for (int n = 1; n < 10; ++n) {
      const double v = n * std::pow(10, d);
      if (!x.holds(v)) continue;
      line(x.at(v), kTop, x.at(v), kBottom, n == 1);
      if (n == 1)
        out << "<text x=\"" << fixed(x.at(v)) << "\" y=\"" << kBottom + 20
            << "\" text-anchor=\"middle\">" << decade_text(d) << "</text>\n";
      else if ((n == 2 || n == 5) && x.last_decade() - x.first_decade() < 3)
        out << "<text x=\"" << fixed(x.at(v)) << "\" y=\"" << kBottom + 20
            << "\" text-anchor=\"middle\" fill=\"" << kFaint << "\">" << v << "</text>\n";
    }
  for (int d = y.first_decade(); d <= y.last_decade(); ++d)
    for (int n = 1; n < 10; ++n) {
      const double v = n * std::pow(10, d);
      if (!y.holds(v)) continue;
      line(kLeft, y.at(v), kRight, y.at(v), n == 1);
      if (n == 1)
        out << "<text x=\"" << kLeft - 10 << "\" y=\"" << fixed(y.at(v) + 4)
            << "\" text-anchor=\"end\">" << decade_text(d) << "</text>\n";
    }
}

// What no method does better: the area below and left of it is out of reach so far.
void overall_front(std::ostream& out, const Plot& plot, const Axis& x, const Axis& y) {
  std::vector<PlotPoint> all;
  for (const PlotSeries& s : plot.series) all.insert(all.end(), s.points.begin(), s.points.end());
  const std::vector<PlotPoint> front = front_of(std::move(all));
  if (front.empty()) return;
  out << "<path d=\"M" << fixed(x.at(front[0].x)) << ' ' << fixed(kTop);
  for (const PlotPoint& p : front)
    out << 'V' << fixed(y.at(p.y)) << (&p == &front.back() ? "" : "H" + fixed(x.at((&p)[1].x)));
  out << 'H' << fixed(kRight) << "V" << fixed(kTop) << "Z\" fill=\"#f3f6fa\"/>\n";
}

void draw_series(std::ostream& out, const PlotSeries& s, const char* colour, const Axis& x,
                 const Axis& y) {
  const std::vector<PlotPoint> front = front_of(s.points);
  const auto on_front = [&](const PlotPoint& p) {
    return std::any_of(front.begin(), front.end(),
                       [&](const PlotPoint& f) { return f.x == p.x && f.y == p.y; });
  };
  out << "<path fill=\"none\" stroke=\"" << colour
      << "\" stroke-width=\"2.2\" stroke-linejoin=\"round\" d=\"";
  for (const PlotPoint& p : front)
    out << (&p == &front[0] ? 'M' : 'L') << fixed(x.at(p.x)) << ' ' << fixed(y.at(p.y));
  out << "\"/>\n";
  for (const PlotPoint& p : s.points) {
    const bool best = on_front(p);
    out << "<circle cx=\"" << fixed(x.at(p.x)) << "\" cy=\"" << fixed(y.at(p.y)) << "\" r=\""
        << (best ? "4" : "2.4") << "\" fill=\"" << colour << "\""
        << (best ? " stroke=\"#fff\" stroke-width=\"1.4\"" : " opacity=\"0.3\"") << "><title>"
        << escaped(s.name + ", " + p.label) << "</title></circle>\n";
  }
}

// Names beside the ends of their lines, moved apart until none covers another.
void names(std::ostream& out, const Plot& plot, const Axis& x, const Axis& y) {
  struct Name {
    std::size_t series;
    double y, end_x, end_y;
  };
  std::vector<Name> all;
  for (std::size_t n = 0; n < plot.series.size(); ++n) {
    const auto front = front_of(plot.series[n].points);
    if (front.empty()) continue;
    const double end = y.at(front.back().y);
    all.push_back({n, end, x.at(front.back().x), end});
  }
  std::sort(all.begin(), all.end(), [](const Name& a, const Name& b) { return a.y < b.y; });
  constexpr double kLine = 21;
  for (int pass = 0; pass < 200; ++pass)
    for (std::size_t n = 0; n + 1 < all.size(); ++n)
      if (const double overlap = kLine - (all[n + 1].y - all[n].y); overlap > 0) {
        all[n].y = std::max(kTop + 8, all[n].y - overlap / 2);
        all[n + 1].y = std::min(kBottom - 4, all[n + 1].y + overlap / 2);
      }
  for (const Name& n : all) {
    const char* colour = kColours[n.series % kColours.size()];
    out << "<path fill=\"none\" stroke=\"" << colour
        << "\" stroke-opacity=\"0.45\" stroke-dasharray=\"1 3\" d=\"M" << fixed(n.end_x + 6) << ' '
        << fixed(n.end_y) << 'L' << fixed(kRight) << ' ' << fixed(n.y) << "H" << fixed(kRight + 8)
        << "\"/>\n<text x=\"" << fixed(kRight + 12) << "\" y=\"" << fixed(n.y + 4) << "\" fill=\""
        << colour << "\" font-weight=\"600\">" << escaped(plot.series[n.series].name)
        << "</text>\n";
  }
}

void target(std::ostream& out, const Plot& plot, const Axis& x, const Axis& y) {
  if (plot.target_x <= 0) return;
  const double tx = x.at(plot.target_x), ty = y.at(plot.target_y);
  out << "<path d=\"M" << fixed(kLeft) << ' ' << fixed(ty) << 'H' << fixed(tx) << 'V'
      << fixed(kBottom) << "\" fill=\"none\" stroke=\"" << kInk
      << "\" stroke-dasharray=\"5 4\" stroke-opacity=\"0.55\"/>\n"
      << "<text x=\"" << fixed(kLeft + 8) << "\" y=\"" << fixed(ty - 6)
      << "\" font-style=\"italic\">asked of springs, one thread</text>\n";
}

// Below the title, in two lines where it is too long for one.
void subtitle(std::ostream& out, const std::string& words) {
  constexpr std::size_t kLine = 125;  // letters
  const std::size_t space = words.size() > kLine ? words.rfind(' ', kLine) : std::string::npos;
  const auto line = [&](const std::string& part, int y) {
    out << "<text x=\"" << kLeft << "\" y=\"" << y << "\" fill=\"#5b6472\">" << escaped(part)
        << "</text>\n";
  };
  if (space == std::string::npos) return line(words, 59);
  line(words.substr(0, space), 55);
  line(words.substr(space + 1), 71);
}

}  // namespace

std::string to_svg(const Plot& plot) {
  const Extent e = extent_of(plot);
  const Axis x(e.x0, e.x1, kLeft, kRight), y(e.y0, e.y1, kBottom, kTop);
  std::ostringstream out;
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << kWidth << ' ' << kHeight
      << "\" font-family=\"Inter, 'Helvetica Neue', Arial, sans-serif\" font-size=\"12\" fill=\""
      << kInk << "\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
      << "<text x=\"" << kLeft << "\" y=\"36\" font-size=\"19\" font-weight=\"700\">"
      << escaped(plot.title) << "</text>\n";
  subtitle(out, plot.subtitle);
  overall_front(out, plot, x, y);
  grid(out, x, y);
  out << "<path d=\"M" << kLeft << ' ' << kTop << 'V' << kBottom << 'H' << kRight
      << "\" fill=\"none\" stroke=\"" << kInk << "\"/>\n<text x=\"" << (kLeft + kRight) / 2
      << "\" y=\"" << kBottom + 44 << "\" text-anchor=\"middle\">" << escaped(plot.x_label)
      << "</text>\n<text transform=\"translate(24 " << (kTop + kBottom) / 2
      << ") rotate(-90)\" text-anchor=\"middle\">" << escaped(plot.y_label) << "</text>\n";
  target(out, plot, x, y);
  for (std::size_t n = 0; n < plot.series.size(); ++n)
    draw_series(out, plot.series[n], kColours[n % kColours.size()], x, y);
  names(out, plot, x, y);
  out << "</svg>\n";
  return out.str();
}

void write_plot(const std::string& path, const Plot& plot) {
  if (plot.series.empty()) return;
  std::ofstream out(path + ".svg");
  if (!(out << to_svg(plot)) || !out.flush())
    throw std::runtime_error("cannot write " + path + ".svg");
  const char* converter = "/usr/bin/rsvg-convert";
  if (access(converter, X_OK) != 0) return;
  const std::string command =
      std::string(converter) + " -z 2 -o '" + path + ".png' '" + path + ".svg'";
  if (std::system(command.c_str()) != 0)
    std::fprintf(stderr, "accuracy: %s.png was not written\n", path.c_str());
}

}  // namespace bench
