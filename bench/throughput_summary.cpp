// What `throughput` says at its end: required figures, ratios, and the file for the report.
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "limits.h"
#include "machine.h"
#include "throughput.h"

namespace bench {
namespace {

const Figure* named(const std::vector<Figure>& all, const std::string& name) {
  for (const Figure& f : all)
    if (f.name == name && f.error.empty()) return &f;
  return nullptr;
}

std::string step_name(const std::string& way, int n, int threads) {
  return "step/" + way + "/" + std::to_string(n) + "/" + weft::simd_name(widest()) +
         "/threads:" + std::to_string(threads);
}

void print_required(const std::vector<Figure>& all, const std::string& way, const char* counter,
                    double most) {
  for (int n : {100, 316}) {
    const Figure* f = named(all, step_name(way, n, 1));
    if (!f) continue;
    std::printf("  %-26s N=%-4d %6.3f %s (<= %g): %-6s %.2f times the yardstick\n", way.c_str(), n,
                f->counter(counter), counter, most, f->counter(counter) <= most ? "met" : "MISSED",
                f->counter("x yardstick"));
  }
}

// A sweep alone, without the prediction.
void print_line_sweeps(const std::vector<Figure>& all) {
  constexpr double kMost = 0.9;
  for (const Figure& f : all) {
    const std::string first = "stage/compliant line, ";
    if (f.name.rfind(first, 0) != 0 || !f.name.ends_with(weft::simd_name(widest())) ||
        f.name.find("/line/") == std::string::npos || !f.error.empty())
      continue;
    const double ns = f.counter("ns/constraint");
    std::printf("  a sweep of lines           %-6s %6.3f ns/constraint (<= %g): %s\n",
                f.name.substr(first.size(), f.name.find('/', first.size()) - first.size()).c_str(),
                ns, kMost, ns <= kMost ? "met" : "MISSED");
  }
}

void print_speed_up(const std::vector<Figure>& all) {
  std::printf("\nTwo threads over one\n");
  for (const char* way : {"spring", "compliant_gauss_seidel", "compliant_jacobi", "compliant_line"})
    for (int n : {100, 316, 1000}) {
      const Figure *one = named(all, step_name(way, n, 1)), *two = named(all, step_name(way, n, 2));
      if (!one || !two) continue;
      const double ratio = one->counter("ms") / two->counter("ms");
      std::printf("  %-26s N=%-4d %5.2f%s\n", way, n, ratio,
                  n != 316       ? ""
                  : ratio >= 1.6 ? " (>= 1.6): met"
                                 : " (>= 1.6): MISSED");
    }
}

// Of four sheets side by side.
void print_side_by_side(const std::vector<Figure>& all) {
  std::printf("\nTwo threads over one, four sheets\n");
  for (const Figure& one : all) {
    const std::string last = "/threads:1";
    if (one.name.rfind("four/", 0) != 0 || !one.name.ends_with(last) || !one.error.empty())
      continue;
    const std::string name = one.name.substr(0, one.name.size() - last.size());
    if (const Figure* two = named(all, name + "/threads:2"))
      std::printf("  %-36s %5.2f\n", name.c_str() + 5, one.counter("ms") / two->counter("ms"));
  }
}

void print_features(const std::vector<Figure>& all) {
  std::printf("\nCost of features, in percent of the plain step\n");
  for (const Figure& f : all) {
    if (f.name.rfind("feature/", 0) != 0) continue;
    const Figure* plain = named(all, "feature/plain" + f.name.substr(f.name.rfind('/')));
    if (!f.error.empty())
      std::printf("  %-32s %s\n", f.name.c_str() + 8, f.error.c_str());
    else if (plain && plain != &f)
      std::printf("  %-32s %+6.1f %%\n", f.name.c_str() + 8,
                  100 * (f.counter("ms") / plain->counter("ms") - 1));
  }
}

}  // namespace

double Figure::counter(const std::string& counter_name) const {
  for (const auto& [key, value] : counters)
    if (key == counter_name) return value;
  return 0;
}

void print_summary(const std::vector<Figure>& all) {
  std::printf("\nRequired, one thread, %s\n", weft::simd_name(widest()));
  print_required(all, "spring", "ns/particle", 1.7);
  print_required(all, "compliant_gauss_seidel", "ns/constraint", 0.45);
  print_required(all, "positional_gauss_seidel", "ns/constraint", 0.45);
  print_required(all, "compliant_jacobi", "ns/constraint", 0.4);
  print_required(all, "positional_jacobi", "ns/constraint", 0.4);
  print_line_sweeps(all);
  print_speed_up(all);
  print_side_by_side(all);
  print_features(all);
}

void write_figures(const std::string& path, const std::vector<Figure>& all) {
  nlohmann::ordered_json j;
  const Machine& m = machine();
  j["machine"] = {
      {"cpu", m.cpu}, {"cores", m.cores}, {"compiler", m.compiler}, {"system", m.system}};
  for (const Limits::Level& l : limits().triad) j["limits"]["triad"][l.name] = l.gigabytes;
  for (weft::Simd s : {weft::Simd::scalar, weft::Simd::sse2, weft::Simd::avx2, weft::Simd::avx512})
    if (weft::simd_available(s))
      j["limits"]["sqrt_div_ns"][weft::simd_name(s)] = limits().sqrt_div(s);
  j["widest"] = weft::simd_name(widest());
  for (const Figure& f : all) {
    nlohmann::ordered_json figure{{"name", f.name}, {"error", f.error}};
    for (const auto& [key, value] : f.counters) figure[key] = value;
    j["figures"].push_back(std::move(figure));
  }
  std::ofstream out(path);
  if (!(out << j.dump(1) << '\n')) throw std::runtime_error("cannot write " + path);
}

}  // namespace bench
