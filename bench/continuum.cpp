// continuum: whole-run wall time against distance from the sheet that a grid stands for, with resolution, method
// and substeps all free.
//
// The truth is Richardson's limit of two grids in double precision (reference.h), of 129 and 257 points a side;
// coarser grids, whose points are among those, are compared with it there. For each problem the program prints
// the settings that no other beats in both time and error, what each method needs for some errors, and how the
// error falls with the spacing; it writes continuum_NAME.svg (and .png) and continuum.csv into --out.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>

#include "machine.h"
#include "peer.h"
#include "plot.h"
#include "trial.h"

namespace {

using bench::Problem;
using bench::Setting;

constexpr int kFinest = 129;  // points a side of the coarser grid of the truth

struct Sheet {
  std::string name, about;
  bool springs;  // or a membrane
  std::function<void(weft::Cloth&)> fabric;
};

// A sheet of 1 m, held along one side, falls for half a second.
const std::vector<Sheet>& sheets() {
  static const std::vector<Sheet> all{
      {"curtain", "springs: structural 1000, shear 500 N/m; D = 1e-3 N m", true,
       [](weft::Cloth& c) {
         c.stiffness = {1000, 500, 0};
         c.bending = 1e-3;
       }},
      {"curtain_membrane", "membrane: C11 = C22 = 1500, C12 = C66 = 500 N/m; D = 1e-3 N m", false,
       [](weft::Cloth& c) {
         c.membrane = {1500, 1500, 500, 500, 0};
         c.bending = 1e-3;
       }},
      {"woven", "membrane: C11 = 3000, C22 = 2000, C12 = 200, C66 = 80 N/m; D = 2e-4 N m", false,
       [](weft::Cloth& c) {
         c.membrane = {3000, 2000, 200, 80, 0};
         c.bending = 2e-4;
       }},
  };
  return all;
}

Problem problem_of(const Sheet& sheet, int n) {
  Problem p;
  p.name = sheet.name;
  p.about = sheet.about;
  p.size = n;
  p.question.seconds = 0.5;
  p.question.tolerance = 2e-6;
  p.question.most_halvings = 2;
  weft::Scene& scene = p.question.scene;
  scene.gravity = {2, -9, 3};
  scene.time.seconds = 0.5;
  weft::Cloth& cloth = scene.cloths.emplace_back();
  cloth.grid = {n, n, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.density = 0.3;
  cloth.drag = 1;
  sheet.fabric(cloth);
  for (int j = 0; j < n; ++j) cloth.pins.push_back({0, j, {}});
  return p;
}

// The points of a grid that a coarser one of n points a side has, too.
std::vector<double> at_points_of(int n, const std::vector<double>& fine, int finer) {
  std::vector<double> some;
  const int step = (finer - 1) / (n - 1);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k)
        some.push_back(fine[3 * std::size_t(j * step * finer + i * step) + std::size_t(k)]);
  return some;
}

struct Truth {
  std::vector<double> positions;  // of kFinest points a side
  double error = 0;               // m
};

// The error is of second order in the spacing: a third of what halving it changes is left in the finer grid. What
// is left of the limit is less by a factor that the order's own constancy tells; a tenth is far above it.
Truth truth_of(const Sheet& sheet) {
  const bench::Reference coarse =
      reference(problem_of(sheet, kFinest).question, WEFT_REFERENCE_CACHE);
  const bench::Reference fine =
      reference(problem_of(sheet, 2 * kFinest - 1).question, WEFT_REFERENCE_CACHE);
  const std::vector<double> at = at_points_of(kFinest, fine.positions, 2 * kFinest - 1);
  Truth truth{at, 0};
  for (std::size_t k = 0; k < at.size(); ++k)
    truth.positions[k] += (at[k] - coarse.positions[k]) / 3;
  const double left = bench::distance(at, truth.positions).rms;
  truth.error = left / 10 + coarse.error + fine.error;
  std::printf("truth: %d and %d points a side, %.1e m apart from the limit; known to %.1e m\n",
              kFinest, 2 * kFinest - 1, left, truth.error);
  return truth;
}

Setting setting(const std::string& name, int substeps) {
  Setting s;
  s.method = name;
  s.substeps = substeps;
  return s;
}
Setting lines(int order, int substeps) {
  Setting s = setting(order == 1 ? "lines" : "lines, order 2", substeps);
  s.solver.method = weft::Method::compliant;
  s.solver.sweep = weft::Sweep::line;
  s.solver.order = order;
  return s;
}

std::vector<Setting> settings_of(const Sheet& sheet, bool quick) {
  std::vector<Setting> all{setting(sheet.springs ? "springs" : "membrane", weft::kAutoSubsteps)};
  if (sheet.springs) all.push_back(setting("springs, all alike", weft::kAutoSubsteps));
  for (const int substeps : {4, 8, 16, 32, 64, 128})
    if (!quick || substeps == 16) all.push_back(lines(2, substeps));
  for (const int substeps : {16, 64})
    if (!quick) all.push_back(lines(1, substeps));
  return all;
}

// Bullet's soft body, of springs as it knows them, with one solver iteration for each of our substeps.
bench::Trial bullet(const Problem& p, int substeps, const std::vector<double>& truth) {
  bench::Trial t;
  t.problem = p.name;
  t.size = p.size;
  t.setting = setting("Bullet", substeps);
  t.substeps = substeps;
  t.frames = 30;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const auto peer = bench::make_bullet_peer(p.question.scene, substeps);
    if (!peer) {
      t.note = "not in this build";
      return t;
    }
    const auto start = std::chrono::steady_clock::now();
    for (int frame = 0; frame < t.frames; ++frame) peer->advance_frame();
    const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - start;
    t.run_ms = repeat == 0 ? ms.count() : std::min(t.run_ms, ms.count());
    t.rms = bench::distance(peer->positions(), truth).rms;
  }
  return t;
}

std::vector<bench::Trial> run_sheet(const Sheet& sheet, const Truth& truth, bool quick,
                                    double seconds) {
  std::vector<bench::Trial> trials;
  const std::vector<int> sizes = quick ? std::vector{17, 33} : std::vector{9, 17, 33, 65, 129};
  for (const int n : sizes) {
    const std::vector<double> at = at_points_of(n, truth.positions, kFinest);
    for (const Setting& s : settings_of(sheet, quick)) {
      Problem p = problem_of(sheet, n);
      if (s.method == "springs, all alike")
        p.question.scene.cloths[0].lumping = weft::Lumping::equal;
      trials.push_back(bench::run_trial(p, s, weft::Simd::best, 1, at, {seconds, 3, 30}));
    }
    if (sheet.springs && n <= 65)
      for (const int substeps : {1, 16})
        trials.push_back(bullet(problem_of(sheet, n), substeps, at));
  }
  return trials;
}

void print_front(std::vector<bench::Trial> trials, bool all) {
  std::sort(trials.begin(), trials.end(),
            [](const bench::Trial& a, const bench::Trial& b) { return a.run_ms < b.run_ms; });
  std::printf("\n| run [ms] | distance [m] | method | points a side | substeps | |\n");
  std::printf("|---:|---:|---|---:|---:|---|\n");
  for (const bench::Trial& t : trials)
    if (t.ok() && (all || t.on_front))
      std::printf("| %.2f | %.1e | %s | %d | %d | %s |\n", t.run_ms, t.rms,
                  t.setting.method.c_str(), t.size, t.substeps, t.on_front ? "front" : "");
    else if (all)
      std::printf("| | | %s | %d | | %s |\n", t.setting.method.c_str(), t.size, t.note.c_str());
}

// The fastest run of each method that comes so near.
void print_needed(const std::vector<bench::Trial>& trials) {
  std::vector<std::string> methods;
  for (const bench::Trial& t : trials)
    if (std::find(methods.begin(), methods.end(), t.setting.method) == methods.end())
      methods.push_back(t.setting.method);
  constexpr double kErrors[] = {1e-2, 1.6e-3, 4.5e-4};
  std::printf("\n| method | to 1e-2 m [ms] | to 1.6e-3 m | to 4.5e-4 m |\n|---|---:|---:|---:|\n");
  for (const std::string& method : methods) {
    std::printf("| %s |", method.c_str());
    for (const double error : kErrors) {
      double least = 0, nearest = 0;
      for (const bench::Trial& t : trials) {
        if (t.setting.method != method || !t.ok()) continue;
        if (t.rms <= error && (least == 0 || t.run_ms < least)) least = t.run_ms;
        if (nearest == 0 || t.rms < nearest) nearest = t.rms;
      }
      if (least > 0)
        std::printf(" %.2f |", least);
      else
        nearest > 0 ? std::printf(" (%.1e m) |", nearest) : std::printf(" none ran |");
    }
    std::printf("\n");
  }
}

// How the error of automatic substeps falls with the spacing.
void print_orders(const std::vector<bench::Trial>& trials) {
  std::printf("\n| method | points a side: distance [m] (order) |\n|---|---|\n");
  for (const std::string method : {"springs", "springs, all alike", "membrane"}) {
    double before = 0;
    for (const bench::Trial& t : trials) {
      if (t.setting.method != method || !t.ok()) continue;
      if (before == 0) std::printf("| %s |", method.c_str());
      std::printf(" %d: %.1e", t.size, t.rms);
      if (before > 0) std::printf(" (%.2f)", std::log2(before / t.rms));
      before = t.rms;
    }
    if (before > 0) std::printf(" |\n");
  }
}

void write(const std::string& folder, const Sheet& sheet, const Truth& truth,
           const std::vector<bench::Trial>& trials, std::ofstream& csv) {
  bench::Plot plot;
  plot.title = sheet.name + ": half a second on one thread";
  char known[80];
  std::snprintf(known, sizeof known, "; the limit is known to %.0e m", truth.error);
  plot.subtitle = sheet.about + known;
  plot.x_label = "run [ms]";
  plot.y_label = "RMS distance from the continuum [m]";
  for (const bench::Trial& t : trials) {
    if (!t.ok()) continue;
    auto series = std::find_if(plot.series.begin(), plot.series.end(),
                               [&](const auto& s) { return s.name == t.setting.method; });
    if (series == plot.series.end())
      series = plot.series.insert(series, bench::PlotSeries{t.setting.method, {}});
    series->points.push_back(
        {t.run_ms, t.rms,
         std::to_string(t.size) + " points, " + std::to_string(t.substeps) + " substeps"});
    csv << sheet.name << ',' << '"' << t.setting.method << '"' << ',' << t.size << ',' << t.substeps
        << ',' << t.run_ms << ',' << t.rms << '\n';
  }
  bench::write_plot(folder + "/continuum_" + sheet.name, plot);
}

struct Command {
  bool quick = false, all = false;
  double seconds = 0.5;
  std::string out = ".";
};

int run(const Command& c) {
  std::printf("%s\n", bench::machine_line().c_str());
  std::filesystem::create_directories(c.out);
  std::ofstream csv(c.out + "/continuum.csv");
  csv << "problem,method,points,substeps,run_ms,rms\n";
  for (const Sheet& sheet : sheets()) {
    std::printf("\n## %s\n\n%s. ", sheet.name.c_str(), sheet.about.c_str());
    const Truth truth = truth_of(sheet);
    std::vector<bench::Trial> trials = run_sheet(sheet, truth, c.quick, c.seconds);
    bench::mark_front(trials, true);
    print_front(trials, c.all);
    print_needed(trials);
    print_orders(trials);
    write(c.out, sheet, truth, trials, csv);
    std::fflush(stdout);
  }
  csv.close();
  if (!csv) throw std::runtime_error(c.out + "/continuum.csv cannot be written");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"continuum: run time against distance from the continuum", "continuum"};
  Command command;
  app.add_option("--seconds", command.seconds, "time to spend on repeating one setting");
  app.add_option("--out", command.out, "folder for continuum.csv and the diagrams");
  app.add_flag("--short", command.quick, "few sizes and settings");
  app.add_flag("--all", command.all, "print every setting, not only the front");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(command);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "continuum: %s\n", e.what());
    return 1;
  }
}
