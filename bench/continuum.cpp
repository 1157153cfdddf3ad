// continuum: whole-run wall time against distance from the sheet that a grid stands for, with resolution, method
// and substeps all free.
//
// The sheets and what they tend to are in sheets.h: Richardson's limit of grids in double precision, or a closed
// form. Grids are compared with it at their own points. For each sheet the program prints the settings that no
// other beats in both time and error, what each method needs for some errors, and how the error falls with the
// spacing; it writes continuum_NAME.svg (and .png) and continuum.csv into --out.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "machine.h"
#include "peer.h"
#include "peer_blender.h"
#include "plot.h"
#include "sheets.h"
#include "trial.h"

namespace {

using bench::Problem;
using bench::Setting;
using bench::Sheet;
using bench::Trial;
using bench::Truth;

Setting setting(const std::string& name, int substeps) {
  Setting s;
  s.method = name;
  s.substeps = substeps;
  return s;
}

Setting compliant(weft::Sweep sweep, int order, int substeps) {
  const std::string name = sweep == weft::Sweep::line ? "lines" : "Gauss-Seidel";
  Setting s = setting(order == 1 ? name : name + ", order 2", substeps);
  s.solver.method = weft::Method::compliant;
  s.solver.sweep = sweep;
  s.solver.order = order;
  return s;
}

constexpr const char* kAlike = ", all alike";  // edges that do not count half

const char* forces_of(const weft::Cloth& cloth) {
  return cloth.membrane.given() ? "membrane" : "springs";
}

std::vector<Setting> settings_of(const weft::Cloth& cloth, bool quick) {
  constexpr weft::Sweep kLine = weft::Sweep::line, kGaussSeidel = weft::Sweep::gauss_seidel;
  const std::string forces = forces_of(cloth);
  std::vector<Setting> all{setting(forces, weft::kAutoSubsteps),
                           setting(forces + kAlike, weft::kAutoSubsteps)};
  if (quick) {
    all.push_back(compliant(kLine, 2, 16));
    all.push_back(compliant(kGaussSeidel, 1, 16));
    return all;
  }
  for (const int substeps : {4, 8, 16, 32, 64, 128}) all.push_back(compliant(kLine, 2, substeps));
  for (const int substeps : {16, 64}) all.push_back(compliant(kLine, 1, substeps));
  for (const int substeps : {16, 64, 256}) all.push_back(compliant(kGaussSeidel, 1, substeps));
  for (const int substeps : {16, 64}) all.push_back(compliant(kGaussSeidel, 2, substeps));
  return all;
}

Trial trial_of(const Problem& p, const std::string& solver, int substeps, int frames) {
  Trial t;
  t.problem = p.name;
  t.size = p.size;
  t.setting = setting(solver, substeps);
  t.substeps = substeps;
  t.frames = frames;
  return t;
}

// Bullet's soft body, of springs as it knows them, with one solver iteration for each of our substeps.
Trial bullet(const Problem& p, int substeps, const std::vector<double>& truth) {
  Trial t = trial_of(p, "Bullet", substeps, int(std::lround(p.question.seconds * 60)));
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
    if (!(t.rms < 10)) t.note = "blew up";
  }
  return t;
}

// Blender's cloth, of springs and angular bending, one run of each setting.
void add_blender(const Problem& p, const std::vector<bench::BlenderSetting>& settings,
                 const std::vector<double>& truth, std::vector<Trial>& trials) {
  std::vector<bench::BlenderRun> runs;
  try {
    runs = bench::run_blender(p.question.scene, p.question.seconds, settings);
  } catch (const std::runtime_error& e) {
    std::fprintf(stderr, "continuum: %s with %d points is without %s\n", p.name.c_str(), p.size,
                 e.what());
  }
  for (std::size_t n = 0; n < runs.size(); ++n) {
    Trial t = trial_of(p, "Blender", settings[n].substeps, settings[n].frames);
    t.substeps = settings[n].substeps * settings[n].frames / settings[0].frames;
    t.run_ms = runs[n].ms;
    if (runs[n].positions.size() == truth.size())
      t.rms = bench::distance(runs[n].positions, truth).rms;
    else
      t.note = "blew up";
    trials.push_back(t);
  }
}

// Why a solver that knows springs alone does not take part, "" where it does.
std::string without_peer(const Sheet& sheet, const std::string& own) {
  if (!sheet.springs) return "springs of one stiffness do not make this fabric";
  return own;
}

void add_peers(const Sheet& sheet, int points, bool quick, const std::vector<double>& truth,
               std::vector<Trial>& trials) {
  if (points > 65 || !sheet.springs) return;
  Problem p = problem_of(sheet, points);
  weft::Cloth& cloth = p.question.scene.cloths[0];
  cloth.membrane = {};
  cloth.stiffness = *sheet.springs;
  if (sheet.without_bullet.empty())
    for (const int substeps : {1, 16}) trials.push_back(bullet(p, substeps, truth));
  if (!bench::without_blender().empty()) return;
  const int frames = int(std::lround(32 * sheet.seconds));
  std::vector<bench::BlenderSetting> settings{{frames, 4}, {frames, 16}};
  if (!quick && points <= 33) settings.insert(settings.end(), {{frames, 64}, {4 * frames, 64}});
  add_blender(p, settings, truth, trials);
}

std::vector<Trial> run_sheet(const Sheet& sheet, const Truth& truth, bool quick, double seconds) {
  std::vector<Trial> trials;
  for (const int n : quick ? std::vector{17, 33} : sheet.sizes) {
    const Problem plain = problem_of(sheet, n);
    const weft::Cloth& cloth = plain.question.scene.cloths[0];
    const std::vector<double> at = truth.at(cloth.grid);
    for (const Setting& s : settings_of(cloth, quick)) {
      Problem p = plain;
      if (s.method.ends_with(kAlike)) p.question.scene.cloths[0].lumping = weft::Lumping::equal;
      trials.push_back(bench::run_trial(p, s, weft::Simd::best, 1, at, {seconds, 3, 30}));
    }
    add_peers(sheet, n, quick, at, trials);
  }
  return trials;
}

void print_front(std::vector<Trial> trials, bool all) {
  std::sort(trials.begin(), trials.end(),
            [](const Trial& a, const Trial& b) { return a.run_ms < b.run_ms; });
  std::printf("\n| run [ms] | distance [m] | method | points a side | substeps | |\n");
  std::printf("|---:|---:|---|---:|---:|---|\n");
  for (const Trial& t : trials)
    if (t.ok() && (all || t.on_front))
      std::printf("| %.2f | %.1e | %s | %d | %d | %s |\n", t.run_ms, t.rms,
                  t.setting.method.c_str(), t.size, t.substeps, t.on_front ? "front" : "");
    else if (all)
      std::printf("| | | %s | %d | | %s |\n", t.setting.method.c_str(), t.size, t.note.c_str());
}

// The fastest run of each method that comes so near.
void print_needed(const std::vector<Trial>& trials) {
  std::vector<std::string> methods;
  for (const Trial& t : trials)
    if (std::find(methods.begin(), methods.end(), t.setting.method) == methods.end())
      methods.push_back(t.setting.method);
  constexpr double kErrors[] = {1e-2, 1.6e-3, 4.5e-4};
  std::printf("\n| method | to 1e-2 m [ms] | to 1.6e-3 m | to 4.5e-4 m |\n|---|---:|---:|---:|\n");
  for (const std::string& method : methods) {
    std::printf("| %s |", method.c_str());
    for (const double error : kErrors) {
      double least = 0, nearest = 0;
      for (const Trial& t : trials) {
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
void print_orders(const std::vector<Trial>& trials) {
  std::printf("\n| method | points a side: distance [m] (order) |\n|---|---|\n");
  for (const std::string method :
       {"springs", "springs, all alike", "membrane", "membrane, all alike"}) {
    double before = 0;
    for (const Trial& t : trials) {
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
           const std::vector<Trial>& trials, std::ofstream& csv) {
  bench::Plot plot;
  plot.title = sheet.name + ": the whole run on one thread";
  char known[80];
  std::snprintf(known, sizeof known, "; the limit is known to %.0e m", truth.error);
  plot.subtitle = sheet.about + known;
  plot.x_label = "run [ms]";
  plot.y_label = "RMS distance from the continuum [m]";
  for (const Trial& t : trials) {
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

void print_truth(const Sheet& sheet, const Truth& truth) {
  std::printf("%s. The limit: %s; it is known to %.1e m.\n", sheet.about.c_str(), truth.how.c_str(),
              truth.error);
  for (const auto& [peer, why] : {std::pair{"Bullet", without_peer(sheet, sheet.without_bullet)},
                                  {"Blender", without_peer(sheet, bench::without_blender())}})
    if (!why.empty()) std::printf("Without %s: %s.\n", peer, why.c_str());
}

struct Command {
  std::vector<std::string> sheets;
  bool quick = false, all = false;
  double seconds = 0.3;
  std::string out = ".";
};

int run(const Command& c) {
  std::printf("%s\n", bench::machine_line().c_str());
  std::filesystem::create_directories(c.out);
  std::ofstream csv(c.out + "/continuum.csv");
  csv << "problem,method,points,substeps,run_ms,rms\n";
  for (const Sheet& sheet : bench::sheets()) {
    if (!c.sheets.empty() &&
        std::find(c.sheets.begin(), c.sheets.end(), sheet.name) == c.sheets.end())
      continue;
    std::printf("\n## %s\n\n", sheet.name.c_str());
    const Truth truth = truth_of(sheet, WEFT_REFERENCE_CACHE);
    print_truth(sheet, truth);
    std::vector<Trial> trials = run_sheet(sheet, truth, c.quick, c.seconds);
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
  app.add_option("sheets", command.sheets, "which; none: all")->check(CLI::IsMember([] {
    std::vector<std::string> names;
    for (const Sheet& sheet : bench::sheets()) names.push_back(sheet.name);
    return names;
  }()));
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
