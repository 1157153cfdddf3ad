// Contact among sheets: what it costs and whether it holds. For every frame of a scene: wall time, contacts,
// the least distance of two that touched (of the distance at which they are held), crossings, the greatest
// strain, energy, momentum. Or random scenes of sheets that meet, and the laws that they break.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <thread>

#include "contact_scenes.h"
#include "machine.h"
#include "meetings.h"
#include "plot.h"
#include "weft/simulation.h"

namespace {

using bench::Plot;
using Clock = std::chrono::steady_clock;

struct FrameOf {
  double ms;
  weft::Report report;
};

// Time is that of the frame alone, without what measures it.
std::vector<FrameOf> run_frames(const weft::Scene& scene, int threads, int frames) {
  weft::Simulation simulation(scene, {.threads = threads});
  std::vector<FrameOf> all;
  for (int n = 0; n < frames; ++n) {
    const auto start = Clock::now();
    simulation.advance_frame();
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    all.push_back({ms, simulation.report()});
  }
  return all;
}

double median_ms(const std::vector<FrameOf>& frames) {
  std::vector<double> ms;
  for (const FrameOf& f : frames) ms.push_back(f.ms);
  std::nth_element(ms.begin(), ms.begin() + std::ptrdiff_t(ms.size() / 2), ms.end());
  return ms[ms.size() / 2];
}

void write_table(const std::string& path, const std::vector<FrameOf>& frames) {
  std::ofstream out(path);
  out << "frame,ms,contacts,least_distance,crossings,strain,energy,px,py,pz\n";
  int n = 0;
  for (const auto& [ms, r] : frames)
    out << ++n << ',' << ms << ',' << r.contact.contacts << ',' << r.contact.least_distance << ','
        << r.penetration.crossings << ',' << r.strain.max << ',' << r.energy.total << ','
        << r.momentum[0] << ',' << r.momentum[1] << ',' << r.momentum[2] << '\n';
  if (!out.flush()) throw std::runtime_error("cannot write " + path);
}

// What holds in the worst frame, and what a frame costs.
void print_summary(const std::string& name, const std::vector<FrameOf>& two, double one) {
  double strain = 0, worst = 0, deepest = 0;
  std::int64_t crossings = 0, contacts = 0;
  for (const auto& [ms, r] : two) {
    strain = std::max(strain, r.strain.max);
    crossings = std::max(crossings, r.penetration.crossings);
    contacts = std::max(contacts, r.contact.contacts);
    deepest = std::max(deepest, r.penetration.collider_max);
    worst = std::max(worst, ms);
  }
  const weft::Report& last = two.back().report;
  std::printf("%-12s %9.1f %9.1f %9.1f %9lld %9.3f %9lld %9.2f %9.2e %9.2e\n", name.c_str(), one,
              median_ms(two), worst, static_cast<long long>(contacts), last.contact.least_distance,
              static_cast<long long>(crossings), 100 * strain, deepest, last.energy.kinetic);
  std::fflush(stdout);
}

bench::PlotSeries time_by_contacts(const std::string& name, const std::vector<FrameOf>& frames) {
  bench::PlotSeries series{name, {}};
  for (const auto& [ms, r] : frames)
    if (r.contact.contacts > 0) series.points.push_back({double(r.contact.contacts), ms, ""});
  return series;
}

struct Asked {
  std::vector<std::string> scenes;
  std::string table, plot;
  int frames = 0;
  double jitter = 0;
};

void run_scenes(const Asked& asked) {
  std::printf("%s\n\n%-12s %9s %9s %9s %9s %9s %9s %9s %9s %9s\n", bench::machine_line().c_str(),
              "scene", "ms 1", "ms 2", "worst", "contacts", "least", "crossings", "strain %",
              "in body", "kinetic J");
  Plot plot{"Contact", "", "contacts", "ms a frame, two threads", {}, 0, 0};
  for (const std::string& name : asked.scenes) {
    const weft::Scene scene = bench::contact_scene(name, asked.jitter);
    const int all = int(std::lround(scene.time.seconds / scene.time.frame));
    const int frames = asked.frames > 0 ? asked.frames : all;
    const std::vector<FrameOf> two = run_frames(scene, 2, frames);
    print_summary(name, two, median_ms(run_frames(scene, 1, frames)));
    if (!asked.table.empty()) write_table(asked.table + "_" + name + ".csv", two);
    plot.series.push_back(time_by_contacts(name, two));
  }
  if (!asked.plot.empty()) bench::write_plot(asked.plot, plot);
}

// Returns how many of them break a law.
int run_meetings(int first, int count) {
  std::atomic<int> next{first}, broken{0};
  std::mutex printing;
  const auto work = [&] {
    for (int n = next++; n < first + count; n = next++) {
      const weft::Scene scene = bench::random_meeting(std::uint64_t(n));
      const std::string laws = bench::broken_laws(scene, bench::run_meeting(scene, 1));
      if (laws.empty()) continue;
      ++broken;
      const std::lock_guard lock(printing);
      std::printf("%d: %s: %s\n", n, laws.c_str(), bench::meeting_name(scene).c_str());
      std::fflush(stdout);
    }
  };
  std::vector<std::jthread> workers;
  for (int k = 0; k < bench::machine().cores; ++k) workers.emplace_back(work);
  workers.clear();
  std::printf("%d of %d random scenes break a law\n", int(broken), count);
  return broken;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Contact among sheets: time, distances, crossings, strain, energy of every frame.");
  Asked asked;
  int random = 0, first = 0;
  std::vector<std::string> names;
  for (const auto& s : bench::contact_scenes()) names.push_back(s.name);
  app.add_option("scenes", asked.scenes, "Which (default: all)")->check(CLI::IsMember(names));
  app.add_option("--frames", asked.frames, "How many of each scene (default: all)")
      ->check(CLI::Range(1, 100000));
  app.add_option("--jitter", asked.jitter, "m, of the particles at the start");
  app.add_option("--csv", asked.table, "Writes PATH_scene.csv with every frame");
  app.add_option("--plot", asked.plot, "Writes PATH.svg, time against contacts");
  app.add_option("--random", random, "So many random scenes of sheets that meet, instead");
  app.add_option("--first", first, "Number of the first of them");
  CLI11_PARSE(app, argc, argv);
  if (random > 0) return run_meetings(first, random) > 0;
  if (asked.scenes.empty()) asked.scenes = names;
  try {
    run_scenes(asked);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "contact: %s\n", e.what());
    return 1;
  }
}
