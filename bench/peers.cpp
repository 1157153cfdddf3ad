// peers: other solvers on the problem `swing`, in the same run as ours, and the ratios at equal
// error.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <limits>
#include <numeric>

#include "machine.h"
#include "peer.h"
#include "peer_blender.h"
#include "tables.h"
#include "trial.h"

namespace {

using bench::Problem;
using bench::Trial;
using Clock = std::chrono::steady_clock;

// The method of ours that is compared besides springs.
const char* const kLine = "compliant line, order 2";

// Per frame at N = 32: as near to the course-style solver's stability limit as whole steps of 16 come.
constexpr int kNearLimit = 48;

struct Solver {
  const char* name;
  std::function<std::unique_ptr<bench::Peer>(const weft::Scene&, int)> make;
  std::vector<int> substeps;  // per frame at N = 32; in proportion to N for larger sheets
};

const std::vector<Solver>& solvers() {
  static const std::vector<Solver> all{
      {"course-style C++", bench::make_course_peer, {kNearLimit, 64, 128, 256}},
      {"Bullet 3.24, classical", bench::make_bullet_peer, {8, 32, 128}},
  };
  return all;
}

// The same measurement as of our own runs: setup apart, fastest repetition, quiet sum of frames.
bool run_peer(const Problem& problem, const Solver& solver, int substeps,
              const std::vector<double>& truth, int repetitions, Trial& t) {
  weft::Scene scene = problem.question.scene;
  t.problem = problem.name;
  t.size = problem.size;
  t.setting.method = solver.name;
  t.setting.substeps = t.substeps = substeps;
  t.frames = 30;
  scene.time.frame = problem.question.seconds / t.frames;
  std::vector<double> fastest(std::size_t(t.frames), std::numeric_limits<double>::infinity());
  t.run_ms = t.setup_ms = fastest[0];
  const auto ms_since = [](Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  };
  for (; t.repetitions < repetitions; ++t.repetitions) {
    auto start = Clock::now();
    const auto peer = solver.make(scene, substeps);
    if (!peer) return false;
    t.setup_ms = std::min(t.setup_ms, ms_since(start));
    double run_ms = 0;
    for (double& best : fastest) {
      start = Clock::now();
      peer->advance_frame();
      const double ms = ms_since(start);
      run_ms += ms;
      best = std::min(best, ms);
    }
    t.run_ms = std::min(t.run_ms, run_ms);
    const bench::Distance d = bench::distance(peer->positions(), truth);
    t.rms = d.rms;
    t.greatest = d.greatest;
    if (!(d.rms < 10)) t.note = "blew up";
  }
  t.quiet_ms = std::accumulate(fastest.begin(), fastest.end(), 0.0);
  return true;
}

// Blender's cloth, run once. It has no springs that skip a particle: its structural ones are as much stiffer as those
// make a sheet that is stretched evenly.
void run_blender(const Problem& problem, bool quick, const std::vector<double>& truth,
                 std::vector<Trial>& trials) {
  if (const std::string why = bench::without_blender(); !why.empty()) {
    std::printf("  Blender is left out: %s\n", why.c_str());
    return;
  }
  weft::Scene scene = problem.question.scene;
  weft::Kinds& k = scene.cloths[0].stiffness;
  k = {k.structural + 4 * k.bend, k.shear, 0};
  std::vector<bench::BlenderSetting> settings{{16, 4}, {16, 16}};
  if (!quick) settings.push_back({16, 64});
  const auto runs = bench::run_blender(scene, problem.question.seconds, settings);
  for (std::size_t n = 0; n < runs.size(); ++n) {
    Trial t;
    t.problem = problem.name;
    t.size = problem.size;
    t.setting.method = "Blender, cloth modifier";
    t.setting.substeps = t.substeps = settings[n].substeps;
    t.setting.frame = problem.question.seconds / settings[n].frames;
    t.frames = settings[n].frames;
    t.repetitions = 1;
    t.run_ms = t.quiet_ms = runs[n].ms;
    if (runs[n].positions.size() == truth.size()) {
      const bench::Distance d = bench::distance(runs[n].positions, truth);
      t.rms = d.rms;
      t.greatest = d.greatest;
    } else {
      t.note = "blew up";
    }
    trials.push_back(t);
  }
}

// Every run of the others against our fastest that is at least as accurate.
void print_ratios(const Problem& problem, const std::vector<Trial>& trials) {
  const auto ours = [](const Trial& t) {
    return t.setting.method == "spring" || t.setting.method == kLine;
  };
  for (const Trial& peer : trials) {
    if (peer.size != problem.size || ours(peer) || !peer.ok()) continue;
    const Trial* best = nullptr;
    for (const Trial& t : trials)
      if (t.size == problem.size && ours(t) && t.ok() && t.rms <= peer.rms &&
          (!best || t.quiet_ms < best->quiet_ms))
        best = &t;
    std::printf("  %-24s %.1e m in %8.1f ms; ", peer.setting.method.c_str(), peer.rms,
                peer.quiet_ms);
    if (best)
      std::printf("ours %.1e m in %7.2f ms (%s, %d threads): %.0f times faster\n", best->rms,
                  best->quiet_ms, best->setting.method.c_str(), best->threads,
                  peer.quiet_ms / best->quiet_ms);
    else
      std::printf("none of ours is as accurate\n");
  }
}

// Per frame, from those of a sheet of 32 x 32.
int substeps_at(const Problem& problem, int substeps) {
  return substeps * problem.size / 32;
}

// Springs as in bench/accuracy and in as few substeps as others can take, and line sweeps in steps fine
// enough for errors in between.
std::vector<bench::Setting> our_settings(const Problem& problem, bool quick) {
  std::vector<bench::Setting> ours{{"spring", {}, substeps_at(problem, kNearLimit)}};
  bool lines = false;
  for (bench::Setting s : bench::settings_for(problem, quick)) {
    if (s.method == "spring" && s.substeps <= 256) ours.push_back(s);
    if (s.method != kLine || s.solver.iterations != 1 || std::exchange(lines, true)) continue;
    for (const int substeps : {4, 8, 10, 12, 16, 20, 24, 28, 32, 64}) {
      s.substeps = substeps;
      ours.push_back(s);
    }
  }
  return ours;
}

void run_size(const Problem& problem, bool quick, std::vector<Trial>& trials) {
  const bench::Reference r = bench::reference(problem.question, WEFT_REFERENCE_CACHE);
  for (const bench::Setting& s : our_settings(problem, quick))
    for (const int threads : {1, 2})
      trials.push_back(
          bench::run_trial(problem, s, weft::Simd::best, threads, r.positions, {0.3, 3, 20}));
  for (const Solver& solver : solvers())
    for (int substeps : solver.substeps) {
      Trial t;
      if (run_peer(problem, solver, substeps_at(problem, substeps), r.positions, quick ? 1 : 3, t))
        trials.push_back(t);
    }
  run_blender(problem, quick, r.positions, trials);
  bench::mark_front(trials);
  bench::print_trials(problem, trials, true);
  print_ratios(problem, trials);
  std::fflush(stdout);
}

int run(const std::vector<int>& sizes, bool quick, const std::string& out) {
  std::printf("%s\n", bench::machine_line().c_str());
  std::filesystem::create_directories(out);
  std::vector<Trial> trials;
  std::vector<Problem> problems;
  for (int n : sizes) {
    problems.push_back(bench::problems_named({"swing"}, n).front());
    run_size(problems.back(), quick, trials);
    bench::write_diagram(out + "/peers_" + std::to_string(n), problems.back(), trials);
  }
  bench::write_json(out + "/peers.json", trials, problems);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"peers: other solvers on the problem swing", "peers"};
  std::vector<int> sizes{32, 64, 100};
  std::string out = ".";
  bool quick = false;
  app.add_option("sizes", sizes, "particles along a side")->check(CLI::Range(8, 400));
  app.add_option("--out", out, "folder for peers.json and the diagrams");
  app.add_flag("--short", quick, "one repetition of the slow ones");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(sizes, quick, out);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "peers: %s\n", e.what());
    return 1;
  }
}
