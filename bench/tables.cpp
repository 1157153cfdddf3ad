// Tables and files of trials (tables.h).
#include "tables.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "machine.h"
#include "plot.h"

namespace bench {
namespace {

bool belongs(const Trial& t, const Problem& p) {
  return t.problem == p.name && t.size == p.size;
}

std::ofstream open(const std::string& path) {
  std::ofstream out(path);
  if (!out) throw std::runtime_error("cannot write " + path);
  return out;
}

// The method, and what else distinguishes the runs of this file.
std::string series_name(const Trial& t, const std::vector<Trial>& all) {
  std::string name = t.setting.method;
  const auto differ = [&](auto&& other) { return std::any_of(all.begin(), all.end(), other); };
  const auto other_set = [&](const Trial& o) {
    return o.ok() && !o.simd.empty() && o.simd != t.simd;
  };
  if (!t.simd.empty() && differ(other_set)) name += ", " + t.simd;
  if (differ([&](const Trial& o) { return o.threads != t.threads; }))
    name += t.threads == 1 ? ", 1 thread" : ", " + std::to_string(t.threads) + " threads";
  return name;
}

std::string quoted(const std::string& text) {
  std::string q = "\"";
  for (char c : text) q += c == '"' ? std::string("\"\"") : std::string(1, c);
  return q + "\"";
}

}  // namespace

void print_trials(const Problem& problem, const std::vector<Trial>& trials, bool all) {
  std::vector<const Trial*> rows;
  for (const Trial& t : trials)
    if (belongs(t, problem) && (all || t.on_front || t.setting.method == "spring"))
      rows.push_back(&t);
  std::sort(rows.begin(), rows.end(),
            [](const Trial* a, const Trial* b) { return a->quiet_ms < b->quiet_ms; });
  const bool strain = problem.measure == Measure::strain;
  std::printf("\n%s: %s\n", problem.title().c_str(), problem.about.c_str());
  std::printf("  %-33s %-24s %-7s %3s %9s %9s %9s %9s  %-9s %-9s\n", "method", "setting", "simd",
              "thr", "setup ms", "run ms", "quiet ms", "ms/frame", strain ? "strain" : "RMS m",
              strain ? "ever" : "most m");
  for (const Trial* t : rows) {
    std::printf("%c %-33s %-24s %-7s %3d ", t->on_front ? '*' : ' ', t->setting.method.c_str(),
                t->setting.text().c_str(), t->simd.c_str(), t->threads);
    if (t->ok())
      std::printf("%9.3f %9.3f %9.3f %9.4f  %-9.2e %-9.2e\n", t->setup_ms, t->run_ms, t->quiet_ms,
                  t->quiet_ms / t->frames, t->rms, t->greatest);
    else
      std::printf("%s\n", t->note.c_str());
  }
  std::printf(
      "  * = on the front: no other is both faster and more accurate; run: fastest repetition;\n"
      "  quiet: every frame's fastest repetition, added up\n");
}

void print_targets(const std::vector<Problem>& problems, const std::vector<Trial>& trials) {
  bool any = false;
  for (const Problem& p : problems) {
    if (p.target_ms <= 0) continue;
    const Trial* best = nullptr;
    for (const Trial& t : trials)
      if (belongs(t, p) && t.ok() && t.threads == 1 && t.setting.method == "spring" &&
          t.setting.substeps == weft::kAutoSubsteps && (!best || t.run_ms < best->run_ms))
        best = &t;
    if (!best) continue;
    if (!any) std::printf("\nRequired: method spring, automatic substeps, one thread, whole run\n");
    any = true;
    std::printf("  %-12s %8.2f ms, quiet %8.2f ms (<= %g): %-6s  RMS %.2e m (<= %.0e): %s\n",
                p.title().c_str(), best->run_ms, best->quiet_ms, p.target_ms,
                best->run_ms <= p.target_ms ? "met" : "MISSED", best->rms, p.target_error,
                best->rms <= p.target_error ? "met" : "MISSED");
  }
}

void write_diagram(const std::string& path, const Problem& problem,
                   const std::vector<Trial>& trials) {
  const bool strain = problem.measure == Measure::strain;
  Plot plot;
  plot.title = problem.title();
  plot.subtitle = problem.about;
  plot.x_label = strain ? "wall time of a frame [ms]" : "wall time of the whole run [ms]";
  plot.y_label = strain ? "greatest structural strain" : "RMS error [m]";
  plot.target_x = problem.target_ms;
  plot.target_y = problem.target_error;
  for (const Trial& t : trials) {
    if (!belongs(t, problem) || !t.ok()) continue;
    const std::string name = series_name(t, trials);
    auto series = std::find_if(plot.series.begin(), plot.series.end(),
                               [&](const PlotSeries& s) { return s.name == name; });
    if (series == plot.series.end()) series = plot.series.insert(series, PlotSeries{name, {}});
    const double ms = strain ? t.quiet_ms / t.frames : t.quiet_ms;
    char text[64];
    std::snprintf(text, sizeof text, ": %.3g ms, %.2e", ms, t.rms);
    series->points.push_back({ms, std::max(t.rms, 1e-9), t.setting.text() + text});
  }
  write_plot(path, plot);
}

void write_csv(const std::string& path, const std::vector<Trial>& trials) {
  std::ofstream out = open(path);
  out << "problem,size,method,setting,simd,threads,substeps,iterations,setup_ms,run_ms,quiet_ms,"
         "frames,"
         "repetitions,rms,greatest,front,note\n";
  for (const Trial& t : trials)
    out << t.problem << ',' << t.size << ',' << quoted(t.setting.method) << ','
        << quoted(t.setting.text()) << ',' << t.simd << ',' << t.threads << ',' << t.substeps << ','
        << t.setting.solver.iterations << ',' << t.setup_ms << ',' << t.run_ms << ',' << t.quiet_ms
        << ',' << t.frames << ',' << t.repetitions << ',' << t.rms << ',' << t.greatest << ','
        << t.on_front << ',' << quoted(t.note) << '\n';
  if (!out) throw std::runtime_error("cannot write " + path);
}

void write_json(const std::string& path, const std::vector<Trial>& trials,
                const std::vector<Problem>& problems) {
  nlohmann::ordered_json j;
  const Machine& m = machine();
  j["machine"] = {
      {"cpu", m.cpu}, {"cores", m.cores}, {"compiler", m.compiler}, {"system", m.system}};
  for (const Problem& p : problems) {
    nlohmann::ordered_json problem{
        {"problem", p.name},
        {"size", p.size},
        {"about", p.about},
        {"measure", p.measure == Measure::strain ? "strain" : "distance"},
        {"target_ms", p.target_ms},
        {"target_error", p.target_error}};
    problem["trials"] = nlohmann::ordered_json::array();
    for (const Trial& t : trials)
      if (belongs(t, p))
        problem["trials"].push_back({{"method", t.setting.method},
                                     {"setting", t.setting.text()},
                                     {"simd", t.simd},
                                     {"threads", t.threads},
                                     {"substeps", t.substeps},
                                     {"setup_ms", t.setup_ms},
                                     {"run_ms", t.run_ms},
                                     {"quiet_ms", t.quiet_ms},
                                     {"frames", t.frames},
                                     {"rms", t.rms},
                                     {"greatest", t.greatest},
                                     {"front", t.on_front},
                                     {"note", t.note}});
    j["problems"].push_back(std::move(problem));
  }
  std::ofstream out = open(path);
  out << j.dump(1) << '\n';
  if (!out) throw std::runtime_error("cannot write " + path);
}

}  // namespace bench
