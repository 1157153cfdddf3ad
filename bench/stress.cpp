// stress: does anything explode? Maps over stiffness, substep, mass, gravity and resolution for every
// method and for a course-style solver, the explosions that the seeds tell of, and random settings.
// Exits with 1 when one of our own runs left its bounds.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "machine.h"
#include "stress_maps.h"

namespace {

using bench::Fate;
using Json = nlohmann::ordered_json;
using Counts = std::array<int, bench::kFates>;

// Calls work(n) for n = 0 … count-1 on all cores.
void on_all_cores(std::size_t count, const char* what,
                  const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> workers;
  const bool shown = isatty(STDERR_FILENO);
  for (int t = 0; t < bench::machine().cores; ++t)
    workers.emplace_back([&, t] {
      for (std::size_t n; (n = next++) < count;) {
        work(n);
        if (shown && t == 0) std::fprintf(stderr, "\r%s %zu/%zu ", what, n + 1, count);
      }
    });
  workers.clear();
  if (shown) std::fprintf(stderr, "\r%50s\r", "");
}

Json json_of(const Counts& counts) {
  Json j;
  for (int f = 0; f < bench::kFates; ++f) j[bench::fate_name(Fate(f))] = counts[std::size_t(f)];
  return j;
}

void print_row(const std::string& name, const Counts& counts) {
  std::printf("  %-34s", name.c_str());
  for (const int c : counts) std::printf(" %10d", c);
  std::printf("\n");
}

void print_head(const std::string& title) {
  std::printf("\n%-36s", title.c_str());
  for (int f = 0; f < bench::kFates; ++f) std::printf(" %10s", bench::fate_name(Fate(f)));
  std::printf("\n");
}

// Runs a map, draws it, and adds it to the file; returns how many of our own cells exploded.
int run_map(bench::MapPlan plan, const std::string& out, Json& file) {
  on_all_cores(plan.cells.size(), plan.name.c_str(), [&](std::size_t n) {
    const auto& cell = plan.cells[n];
    Fate& worst = plan.map.panels[cell.panel].cells[cell.cell];
    for (const auto& c : cell.cases)
      worst =
          std::max(worst, (cell.course ? bench::run_course_stress(c) : bench::run_stress(c)).fate);
  });
  std::vector<Counts> counts(plan.map.panels.size());
  int exploded = 0;
  std::vector<bool> course(plan.map.panels.size());
  for (const auto& cell : plan.cells) {
    const Fate fate = plan.map.panels[cell.panel].cells[cell.cell];
    ++counts[cell.panel][std::size_t(fate)];
    course[cell.panel] = cell.course;
    exploded += !cell.course && fate >= Fate::unbounded;
  }
  print_head(plan.map.title + ", cells");
  Json panels = Json::array();
  for (std::size_t p = 0; p < counts.size(); ++p) {
    print_row(plan.map.panels[p].name, counts[p]);
    panels.push_back({{"name", plan.map.panels[p].name},
                      {"course", bool(course[p])},
                      {"cells", json_of(counts[p])}});
  }
  file["maps"].push_back({{"name", plan.name},
                          {"title", plan.map.title},
                          {"about", plan.map.subtitle},
                          {"runs", plan.cells.size()},
                          {"panels", panels}});
  bench::write_heat_map(out + "/" + plan.name, plan.map);
  return exploded;
}

int run_told(Json& file) {
  const auto all = bench::told_explosions();
  int exploded = 0;
  std::printf("\nThe seeds' explosions\n");
  for (const auto& t : all) {
    const auto ours = bench::run_stress(t.setting), course = bench::run_course_stress(t.setting);
    std::printf("  %-52s course-style: %-10s  ours: %s\n", t.text.c_str(), fate_name(course.fate),
                fate_name(ours.fate));
    file["told"].push_back(
        {{"text", t.text}, {"course", fate_name(course.fate)}, {"ours", fate_name(ours.fate)}});
    exploded += ours.fate >= Fate::unbounded;
  }
  return exploded;
}

int run_random(int count, Json& file) {
  std::vector<bench::Verdict> verdicts(static_cast<std::size_t>(count));
  on_all_cores(verdicts.size(), "random settings",
               [&](std::size_t n) { verdicts[n] = bench::run_stress(bench::random_case(n)); });
  Counts counts{};
  double greatest = 0;
  for (std::size_t n = 0; n < verdicts.size(); ++n) {
    const bench::Verdict& v = verdicts[n];
    ++counts[std::size_t(v.fate)];
    if (v.fate < Fate::unbounded) greatest = std::max(greatest, v.energy);
    if (v.fate >= Fate::unbounded)
      std::printf("  case %zu: %s, energy %.3g-fold %s\n", n, fate_name(v.fate), v.energy,
                  v.why.c_str());
  }
  print_head("Random settings");
  print_row("0 to " + std::to_string(count - 1), counts);
  file["random"] = {{"runs", count}, {"cells", json_of(counts)}, {"energy", greatest}};
  return counts[3] + counts[4];
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"stress: does anything explode?", "stress"};
  std::string out = ".";
  bool quick = false;
  int random = 3000;
  app.add_option("--out", out, "folder for stress.json and the maps");
  app.add_option("--random", random, "random settings to run")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  app.add_flag("--short", quick, "few columns and rows of the maps");
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s\n", bench::machine_line().c_str());
    std::filesystem::create_directories(out);
    const bench::Machine& m = bench::machine();
    Json file{
        {"machine",
         {{"cpu", m.cpu}, {"cores", m.cores}, {"compiler", m.compiler}, {"system", m.system}}}};
    int exploded = 0;
    for (bench::MapPlan& plan : bench::plan_maps(quick))
      exploded += run_map(std::move(plan), out, file);
    exploded += run_told(file);
    exploded += run_random(random, file);
    std::ofstream(out + "/stress.json") << file.dump(1) << '\n';
    return exploded > 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "stress: %s\n", e.what());
    return 1;
  }
}
