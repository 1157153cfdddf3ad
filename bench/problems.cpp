// The problems (problems.h). Sheets are one square metre; frames are a sixtieth of a second where nothing
// else is said.
#include "problems.h"

#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

namespace bench {
namespace {

// The sheet of `swing`: 0.3 kg in all, held by two corners of its first row.
Problem hanging(const std::string& name, int n, double k, double seconds) {
  Problem p;
  p.name = name;
  p.size = n;
  p.question.seconds = seconds;
  weft::Scene& scene = p.question.scene;
  scene.name = name;
  scene.time.seconds = seconds;
  weft::Cloth cloth;
  cloth.grid.nx = cloth.grid.ny = n;
  cloth.lumping = weft::Lumping::equal;  // the lattice itself is meant, as other solvers have it
  cloth.stiffness = {k, k, 0.2 * k};
  cloth.pins = {{0, 0, {}}, {n - 1, 0, {}}};
  scene.cloths.push_back(cloth);
  return p;
}

Problem swing(int n) {
  Problem p = hanging("swing", n, 1000, 0.5);
  p.about = "a sheet of 1 kN/m swings from two corners for half a second, undamped";
  // Far below any error of single precision there is nothing to be learned.
  p.question.tolerance = n <= 64 ? 1e-6 : 1e-5;
  if (n > 200) p.question.most_halvings = 1;
  if (n == 32) p.target_ms = 3, p.target_error = 1e-4;
  if (n == 64) p.target_ms = 18, p.target_error = 5e-4;
  if (n == 100) p.target_ms = 75, p.target_error = 1e-3;
  return p;
}

// As cloth is: it hardly stretches, but it bends.
Problem stiff(int n) {
  Problem p = hanging("stiff", n, 1e5, 0.5);
  p.about =
      "the same with structural and shear springs of 100 kN/m; bending springs of 200 N/m as "
      "before";
  p.question.scene.cloths[0].stiffness.bend = 200;
  p.question.tolerance = 1e-5;
  p.question.most_halvings = 2;
  return p;
}

Problem board(int n) {
  Problem p = hanging("board", n, 1e5, 0.5);
  p.about = "the same with bending springs of 20 kN/m, too: waves of bending take part";
  p.question.tolerance = 1e-5;
  p.question.most_halvings = 2;
  return p;
}

Problem settle(int n) {
  Problem p = hanging("settle", n, 1000, 6);
  p.about = "the sheet of swing comes to rest under a drag of 4/s; error against the equilibrium";
  p.question.scene.cloths[0].drag = 4;
  p.question.at_rest = true;
  return p;
}

Problem sheet(int n) {
  Problem p = hanging("sheet", n, 1e7, 2);
  p.about = "an inextensible sheet hung by two corners for 2 s; greatest structural strain";
  p.measure = Measure::strain;
  p.question.scene.cloths[0].stiffness = {1e7, 1e7, 0};
  p.question.scene.cloths[0].drag = 0.1;
  return p;
}

Problem drape(int n) {
  // From 0.2 s on it buckles: a ball a tenth of a micrometer aside makes it end a centimeter away.
  Problem p = hanging("drape", n, 1000, 0.15);
  p.about = "a sheet falls on a sphere with friction 0.3, 0.15 s, as long as it does not buckle";
  weft::Scene& scene = p.question.scene;
  scene.cloths[0].pins.clear();
  scene.cloths[0].drag = 1;
  weft::Collider ball;
  ball.shape = weft::Sphere{{0.5, -0.33, 0.5}, 0.3};
  ball.friction = {weft::FrictionModel::coulomb, 0.3, 0.3};
  ball.offset = 0.01;
  scene.colliders.push_back(ball);
  p.question.tolerance = 1e-5;
  p.question.most_halvings = 4;
  return p;
}

struct Kind {
  std::function<Problem(int)> make;
  std::vector<int> sizes;
};

const std::map<std::string, Kind>& kinds() {
  static const std::map<std::string, Kind> all{
      {"swing", {swing, {32, 64, 100, 316}}},
      {"stiff", {stiff, {32, 64, 100}}},
      {"board", {board, {32}}},
      {"settle", {settle, {32}}},
      {"sheet", {sheet, {32, 64, 100}}},
      {"drape", {drape, {32}}},
  };
  return all;
}

// The ways of projecting constraints that are compared.
struct Projection {
  const char* name;
  weft::Method method;
  weft::Sweep sweep;
  int order;
  bool tethers;
};

constexpr weft::Method kCompliant = weft::Method::compliant, kRigid = weft::Method::positional;
constexpr weft::Sweep kCoded = weft::Sweep::gauss_seidel, kLine = weft::Sweep::line;

constexpr Projection kElastic[] = {
    {"compliant Gauss-Seidel", kCompliant, kCoded, 1, false},
    {"compliant Jacobi", kCompliant, weft::Sweep::jacobi, 1, false},
    {"compliant line", kCompliant, kLine, 1, false},
    {"compliant line, order 2", kCompliant, kLine, 2, false},
};
constexpr Projection kTethered = {"compliant line, order 2, tethers", kCompliant, kLine, 2, true};
constexpr Projection kInextensible[] = {
    {"positional Gauss-Seidel", kRigid, kCoded, 1, false},
    {"positional Jacobi", kRigid, weft::Sweep::jacobi, 1, false},
    {"positional line", kRigid, kLine, 1, false},
    {"positional line, tethers", kRigid, kLine, 1, true},
    {"compliant line", kCompliant, kLine, 1, false},
    {"compliant line, tethers", kCompliant, kLine, 1, true},
};

void add(std::vector<Setting>& all, const Projection& p, int substeps, int iterations) {
  Setting s;
  s.method = p.name;
  s.solver.method = p.method;
  s.solver.sweep = p.sweep;
  s.solver.order = p.order;
  s.solver.tethers = p.tethers;
  s.solver.iterations = iterations;
  s.substeps = substeps;
  all.push_back(s);
}

void add_springs(std::vector<Setting>& all, bool quick) {
  Setting s;
  s.method = "spring";
  all.push_back(s);
  // Beyond the automatic choice only smaller substeps make sense; larger ones are unstable.
  for (int substeps : {64, 128, 256, 512, 1024}) {
    if (quick && substeps > 256) break;
    s.substeps = substeps;
    all.push_back(s);
  }
}

}  // namespace

std::string Setting::text() const {
  std::string t = substeps == weft::kAutoSubsteps ? "auto" : std::to_string(substeps);
  t += substeps == 1 ? " substep" : " substeps";
  if (solver.method != weft::Method::spring && solver.iterations > 1)
    t += ", " + std::to_string(solver.iterations) + " sweeps";
  if (frame > 0) t += " in 1/" + std::to_string(std::lround(1 / frame)) + " s";
  return t;
}

std::vector<Problem> problems_named(const std::vector<std::string>& names, int size) {
  std::vector<Problem> all;
  for (const std::string& name : names) {
    const auto kind = kinds().find(name);
    if (kind == kinds().end()) throw std::invalid_argument("no problem is called " + name);
    for (int n : size > 0 ? std::vector<int>{size} : kind->second.sizes)
      all.push_back(kind->second.make(n));
  }
  return all;
}

std::vector<std::string> problem_names() {
  return {"swing", "stiff", "board", "settle", "sheet", "drape"};
}

std::vector<Setting> settings_for(const Problem& problem, bool quick) {
  std::vector<Setting> all;
  if (problem.measure == Measure::strain) {
    for (const Projection& p : kInextensible) {
      for (int substeps : {8, 16, 32, 48, 64}) add(all, p, substeps, 1);
      if (!p.tethers) continue;  // the others come to as little only later
      for (int substeps : {10, 12, 14}) add(all, p, substeps, 1);
    }
    return all;
  }
  if (problem.size > 200) {  // the settings that are worth their minutes
    all.push_back({"spring", {}, weft::kAutoSubsteps});
    for (int substeps : {16, 64, 128}) add(all, kElastic[3], substeps, 1);
    return all;
  }
  if (!(quick && problem.name == "stiff" && problem.size > 64)) add_springs(all, quick);
  const std::vector<int> ladder =
      quick ? std::vector<int>{4, 16, 64} : std::vector<int>{1, 2, 4, 8, 16, 32, 64, 128, 256};
  for (const Projection& p : kElastic) {
    for (int substeps : ladder) add(all, p, substeps, 1);
    for (int substeps : ladder)
      for (int iterations : {4, 16})
        if (substeps <= 32 && !quick) add(all, p, substeps, iterations);
  }
  if (problem.name == "stiff" || problem.name == "board") {
    add(all, kTethered, 3, 1);
    add(all, kTethered, 4, 1);
    all.back().frame = 1.0 / 48;
    for (int substeps : ladder) add(all, kTethered, substeps, 1);
  }
  return all;
}

}  // namespace bench
