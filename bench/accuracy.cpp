// accuracy: whole-run wall time against error, for every method, instruction set and thread count.
//
// For each problem it computes (or reads from the cache) the reference, runs every setting, and
// prints the settings that no other beats in both time and error. Beside the tables it writes
// accuracy.csv, accuracy.json and a work-precision diagram of every problem into --out.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "machine.h"
#include "tables.h"
#include "trial.h"

namespace {

struct Command {
  std::vector<std::string> problems{"swing"};
  int size = 0;
  std::vector<int> threads{1};
  std::vector<std::string> simd{"best"};
  bool quick = false, all = false, springs_only = false;
  double seconds = 0.5;
  std::string out = ".";
};

weft::Simd simd_named(const std::string& name) {
  for (weft::Simd s : {weft::Simd::scalar, weft::Simd::sse2, weft::Simd::avx2, weft::Simd::avx512})
    if (name == weft::simd_name(s)) return s;
  return weft::Simd::best;
}

int parse(Command& c, int argc, char** argv) {
  CLI::App app{"accuracy: run time against error", "accuracy"};
  app.add_option("problems", c.problems, "which, or all")->check(CLI::IsMember([] {
    auto names = bench::problem_names();
    names.push_back("all");
    return names;
  }()));
  app.add_option("--size", c.size, "particles along a side, instead of the usual sizes")
      ->check(CLI::Range(4, 1000));
  app.add_option("--threads", c.threads, "thread counts, comma-separated")->delimiter(',');
  app.add_option("--simd", c.simd, "instruction sets, comma-separated")
      ->delimiter(',')
      ->check(CLI::IsMember({"best", "avx512", "avx2", "sse2", "scalar"}));
  app.add_option("--seconds", c.seconds, "time to spend on repeating one setting");
  app.add_option("--out", c.out, "folder for accuracy.csv, accuracy.json and the diagrams");
  app.add_flag("--short", c.quick, "fewer settings");
  app.add_flag("--springs", c.springs_only, "method spring only");
  app.add_flag("--all", c.all, "print every setting, not only the front");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  if (c.problems == std::vector<std::string>{"all"}) c.problems = bench::problem_names();
  return -1;
}

std::vector<double> truth_of(const bench::Problem& p) {
  if (p.measure == bench::Measure::strain) return {};
  const bench::Reference r = bench::reference(p.question, WEFT_REFERENCE_CACHE);
  std::printf("reference %-12s error %.1e m", p.title().c_str(), r.error);
  if (r.steps > 0) std::printf(", %lld substeps", static_cast<long long>(r.steps));
  std::printf(r.cached ? ", from the cache (%.1f s)\n" : ", computed in %.1f s\n", r.seconds);
  return r.positions;
}

void run_problem(const bench::Problem& problem, const Command& c, std::vector<bench::Trial>& all) {
  const std::vector<double> truth = truth_of(problem);
  const bench::Repeats repeats{c.seconds, 3, 30};
  const auto settings = bench::settings_for(problem, c.quick);
  std::size_t done = 0;
  for (const bench::Setting& setting : settings) {
    ++done;
    if (isatty(STDERR_FILENO))
      std::fprintf(stderr, "\r%-12s %zu/%zu ", problem.title().c_str(), done, settings.size());
    if (c.springs_only && setting.method != "spring") continue;
    for (const std::string& simd : c.simd)
      for (int threads : c.threads)
        if (weft::simd_available(simd_named(simd)))
          all.push_back(
              bench::run_trial(problem, setting, simd_named(simd), threads, truth, repeats));
  }
  if (isatty(STDERR_FILENO)) std::fprintf(stderr, "\r%40s\r", "");
}

int run(const Command& c) {
  std::printf("%s\n", bench::machine_line().c_str());
  std::filesystem::create_directories(c.out);
  const auto problems = bench::problems_named(c.problems, c.size);
  std::vector<bench::Trial> trials;
  for (const bench::Problem& p : problems) {
    run_problem(p, c, trials);
    bench::mark_front(trials);
    bench::print_trials(p, trials, c.all);
    bench::write_diagram(c.out + "/" + p.name + "_" + std::to_string(p.size), p, trials);
    std::fflush(stdout);
  }
  bench::print_targets(problems, trials);
  bench::write_csv(c.out + "/accuracy.csv", trials);
  bench::write_json(c.out + "/accuracy.json", trials, problems);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Command command;
  if (const int code = parse(command, argc, argv); code >= 0) return code;
  try {
    return run(command);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "accuracy: %s\n", e.what());
    return 1;
  }
}
