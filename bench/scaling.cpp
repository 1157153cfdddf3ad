// scaling: how a frame scales to more threads than this machine has. Each scene's frame is run on one thread, cut
// into the tasks that P threads would get; its tasks, with the durations measured and with what each waits for, then
// go to P workers by a list schedule that knows what sharing costs here (list_schedule.h). What comes out for the
// threads that there are stands beside what was measured on them.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "list_schedule.h"
#include "machine.h"
#include "plot.h"
#include "recorded_frame.h"
#include "scaling_scenes.h"
#include "sharing_costs.h"

namespace {

using bench::Forecast;
using bench::Host;
using bench::ScalingScene;

struct Command {
  std::vector<std::string> scenes;
  std::vector<int> threads{2, 4, 8, 16, 32, 64};
  std::string out;
  double core_rate = 0, rate = 0, cache = 0;  // GB/s, GB/s, MB; 0: as measured
  int repeats = 7;
  bool quick = false, stages = false;
};

// What one number of threads comes to.
struct Foretold {
  int threads = 1;
  Forecast forecast;
  double work_ns = 0, path_ns = 0;  // of all tasks; of the longest chain of them
  double free_ns = 0;               // where sharing costs nothing
  double in_cache_ns = 0;           // where memory holds nothing up
  double gain(double one_ns) const { return one_ns / forecast.ns; }
};

struct Result {
  ScalingScene scene;
  int substeps = 0;
  bench::RecordedFrame::Times measured;
  int measured_threads = 1;
  std::vector<Foretold> foretold;
  const Foretold* on(int threads) const {
    for (const Foretold& f : foretold)
      if (f.threads == threads) return &f;
    return nullptr;
  }
};

// Cores like this machine's, as many as there are workers: memory that all of them share grows with them unless a
// rate is given.
Host host_of(const bench::SharingCosts& costs, const Command& command, int workers) {
  Host host;
  host.workers = workers;
  host.start_ns = costs.start_ns;
  host.signal_ns = costs.signal_ns;
  host.wake_ns = costs.wake_ns;
  host.handover_ns = costs.handover_ns;
  host.cache_bytes = command.cache > 0 ? command.cache * 1e6 : costs.cache_bytes;
  host.core_rate = command.core_rate > 0 ? command.core_rate : costs.core_rate;
  host.rate = command.rate > 0 ? command.rate
                               : costs.all_rate * std::max(1.0, double(workers) / costs.cores);
  return host;
}

Foretold foretell_on(const bench::TaskGraph& graph, const Host& host) {
  Foretold f;
  f.threads = host.workers;
  f.forecast = bench::foretell(graph, host);
  f.work_ns = graph.work_ns();
  f.path_ns = graph.path_ns();
  Host free = host;
  free.start_ns = free.signal_ns = free.wake_ns = free.handover_ns = 0;
  f.free_ns = bench::foretell(graph, free).ns;
  Host in_cache = host;
  in_cache.cache_bytes = in_cache.core_rate = in_cache.rate = Host::kNone;
  f.in_cache_ns = bench::foretell(graph, in_cache).ns;
  return f;
}

// What holds a frame up most: what it would take without it.
std::string bound_of(const Foretold& f) {
  const double work = f.work_ns / f.threads, sharing = f.forecast.ns - f.free_ns;
  const double memory = f.forecast.ns - f.in_cache_ns;
  const double most = std::max({work, f.path_ns, sharing, memory});
  if (most == work) return "work";
  if (most == f.path_ns) return "path";
  return most == sharing ? "sharing" : "memory";
}

Result run(const ScalingScene& scene, const Command& command, const bench::SharingCosts& costs) {
  bench::RecordedFrame frame(scene.scene, scene.first);
  Result r{scene, frame.substeps(), {}, std::min(costs.cores, 2), {}};
  r.measured = frame.measure(r.measured_threads, command.repeats);
  for (const int threads : command.threads)
    r.foretold.push_back(
        foretell_on(frame.record(threads, command.repeats), host_of(costs, command, threads)));
  return r;
}

void print_head(const bench::SharingCosts& c) {
  std::printf("%s\n\n", bench::machine_line().c_str());
  std::printf(
      "Sharing: %.0f ns a task, %.0f ns to a thread that stands by, %.1f us to one that sleeps, "
      "%.1f ns for 1 kB "
      "that another core has written. Memory: %.0f GB/s a core, %.0f GB/s for %d. Cache: %.0f "
      "MB.\n",
      c.start_ns, c.signal_ns, c.wake_ns * 1e-3, c.handover_ns * 1000, c.core_rate, c.all_rate,
      c.cores, c.cache_bytes * 1e-6);
}

// One scene: a row for each number of threads.
void print_scene(const Result& r) {
  std::printf(
      "\n## %s\n\n%s; a frame of %d substeps takes %.3g ms on one thread, %.2f times less on "
      "%d.\n\n",
      r.scene.name.c_str(), r.scene.about.c_str(), r.substeps, r.measured.one * 1e-6,
      r.measured.one / r.measured.several, r.measured_threads);
  std::printf(
      "| threads | predicted [ms] | gain | work each [ms] | longest path [ms] | sharing [ms] | "
      "memory [ms] | "
      "GB/s | bound by |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Foretold& f : r.foretold)
    std::printf("| %d | %.3g | %.2f | %.3g | %.3g | %.2g | %.2g | %.2g | %s |\n", f.threads,
                f.forecast.ns * 1e-6, f.gain(r.measured.one), f.work_ns / f.threads * 1e-6,
                f.path_ns * 1e-6, std::max(0.0, f.forecast.ns - f.free_ns) * 1e-6,
                std::max(0.0, f.forecast.ns - f.in_cache_ns) * 1e-6,
                f.forecast.memory_bytes / f.forecast.ns, bound_of(f).c_str());
  std::fflush(stdout);
}

// Where the time goes on the most threads.
void print_stages(const Result& r) {
  for (const Foretold& f : r.foretold) {
    std::printf(
        "\n| stage, %d threads | work [ms] | by one thread alone [ms] | predicted [ms] | gain |\n"
        "|---|---|---|---|---|\n",
        f.threads);
    for (const bench::StageTime& s : f.forecast.stages)
      std::printf("| %s | %.3g | %.3g | %.3g | %.2f |\n",
                  s.stage.empty() ? "frame" : s.stage.c_str(), s.work_ns * 1e-6, s.alone_ns * 1e-6,
                  s.elapsed_ns * 1e-6, s.work_ns / s.elapsed_ns);
  }
}

std::string asked(double value, double least) {
  char text[64];
  if (least <= 0)
    std::snprintf(text, sizeof text, "%.2f", value);
  else
    std::snprintf(text, sizeof text, "%.2f (asked %.3g: %s)", value, least,
                  value >= least ? "met" : "**missed**");
  return text;
}

// All scenes, a row each.
void print_summary(const std::vector<Result>& all) {
  std::printf(
      "\n## All scenes\n\n| scene | one thread [ms] | gain on 2, measured | predicted | gain on "
      "16, predicted | "
      "bound by | gain on 64 |\n|---|---|---|---|---|---|---|\n");
  for (const Result& r : all) {
    const Foretold *two = r.on(2), *sixteen = r.on(16), *most = r.on(64);
    const auto gain = [&](const Foretold* f) { return f ? f->gain(r.measured.one) : 0; };
    const double measured = r.measured_threads == 2 ? r.measured.one / r.measured.several : 0;
    std::printf("| %s | %.3g | %s | %.2f | %s | %s | %.1f |\n", r.scene.name.c_str(),
                r.measured.one * 1e-6, asked(measured, r.scene.asked_2).c_str(), gain(two),
                asked(gain(sixteen), r.scene.asked_16).c_str(),
                sixteen ? bound_of(*sixteen).c_str() : "", gain(most));
  }
}

void print_elsewhere(const std::vector<Result>& all) {
  std::printf(
      "\n## Gains measured on an Intel server of 16 cores, an older build / predicted\n\n"
      "| scene | 2 | 4 | 8 | 16 |\n|---|---|---|---|---|\n");
  for (const Result& r : all) {
    if (r.scene.elsewhere.empty()) continue;
    std::printf("| %s |", r.scene.name.c_str());
    for (const bench::MeasuredElsewhere& m : r.scene.elsewhere) {
      const Foretold* f = r.on(m.threads);
      std::printf(" %.1f / %.1f |", m.gain, f ? f->gain(r.measured.one) : 0);
    }
    std::printf("\n");
  }
}

void write(const std::string& folder, const std::vector<Result>& all) {
  std::ofstream csv(folder + "/scaling.csv");
  csv << "scene,threads,predicted_ms,gain,work_ms,path_ms,free_ms,in_cache_ms,memory_bytes,bound,"
         "one_ms,"
         "measured_2_ms\n";
  bench::Plot plot{
      "Threads", "predicted from recorded tasks; the first points of each: one thread, measured",
      "threads", "ms a frame",
      {},        0,
      0};
  for (const Result& r : all) {
    bench::PlotSeries series{r.scene.name, {{1, r.measured.one * 1e-6, "one thread, measured"}}};
    for (const Foretold& f : r.foretold) {
      csv << r.scene.name << ',' << f.threads << ',' << f.forecast.ns * 1e-6 << ','
          << f.gain(r.measured.one) << ',' << f.work_ns * 1e-6 << ',' << f.path_ns * 1e-6 << ','
          << f.free_ns * 1e-6 << ',' << f.in_cache_ns * 1e-6 << ',' << f.forecast.memory_bytes
          << ',' << bound_of(f) << ',' << r.measured.one * 1e-6 << ',' << r.measured.several * 1e-6
          << '\n';
      series.points.push_back(
          {double(f.threads), f.forecast.ns * 1e-6, std::to_string(f.threads) + " threads"});
    }
    plot.series.push_back(std::move(series));
  }
  if (!csv.flush()) throw std::runtime_error("cannot write " + folder + "/scaling.csv");
  bench::write_plot(folder + "/scaling", plot);
}

void run_all(const Command& command) {
  const bench::SharingCosts costs = bench::measure_sharing_costs();
  print_head(costs);
  std::vector<Result> all;
  for (const ScalingScene& scene : bench::scaling_scenes(command.quick)) {
    if (!command.scenes.empty() &&
        std::none_of(command.scenes.begin(), command.scenes.end(), [&](const std::string& part) {
          return scene.name.find(part) != std::string::npos;
        }))
      continue;
    all.push_back(run(scene, command, costs));
    print_scene(all.back());
    if (command.stages) print_stages(all.back());
  }
  print_summary(all);
  print_elsewhere(all);
  if (!command.out.empty()) write(command.out, all);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "How a frame scales to more threads, predicted from its tasks as one thread runs them.");
  Command command;
  app.add_option("scenes", command.scenes,
                 "Those whose names hold one of these words (default: all)");
  app.add_option("--threads", command.threads, "Numbers of threads to predict")
      ->delimiter(',')
      ->check(CLI::Range(2, 256));
  app.add_option("--repeats", command.repeats, "The shortest of so many durations counts")
      ->check(CLI::Range(1, 1000));
  app.add_option("--core-rate", command.core_rate,
                 "GB/s that a core gets from memory (default: measured)")
      ->check(CLI::PositiveNumber);
  app.add_option(
         "--rate", command.rate,
         "GB/s for all cores together (default: measured, times the cores that this machine lacks)")
      ->check(CLI::PositiveNumber);
  app.add_option("--cache", command.cache, "MB of the last level (default: this machine's)")
      ->check(CLI::PositiveNumber);
  app.add_option("--out", command.out, "folder for scaling.csv and the diagram");
  app.add_flag("--stages", command.stages, "Shows where each frame's time goes");
  app.add_flag("--short", command.quick, "Small scenes alone");
  CLI11_PARSE(app, argc, argv);
  try {
    run_all(command);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "scaling: %s\n", e.what());
    return 1;
  }
}
