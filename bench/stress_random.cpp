// Random stress cases (stress_case.h).
#include <cmath>

#include "stress_case.h"
#include "weft/random.h"

namespace bench {
namespace {

using weft::Random;

double log_between(Random& random, double least, double most) {
  return least * std::pow(most / least, random.unit());
}

int pick(Random& random, int count) {
  return int(random.unit() * count);
}

weft::Solver random_solver(Random& random) {
  weft::Solver s;
  s.method = static_cast<weft::Method>(pick(random, 4));
  const bool projects = s.method == weft::Method::positional || s.method == weft::Method::compliant;
  if (projects) s.sweep = static_cast<weft::Sweep>(pick(random, 3));
  s.tethers = projects && pick(random, 4) == 0;
  if (s.method == weft::Method::compliant) s.order = 1 + pick(random, 2);
  s.iterations = pick(random, 3) == 0 ? 1 + pick(random, 50) : 1 + pick(random, 3);
  s.collision_iterations = 1 + pick(random, 2);
  return s;
}

weft::Kinds random_stiffness(Random& random) {
  weft::Kinds k{log_between(random, 0.1, 1e9), 0, 0};
  if (pick(random, 4) > 0) k.shear = k.structural * log_between(random, 0.01, 10);
  if (pick(random, 3) > 0) k.bend = k.structural * log_between(random, 0.001, 1);
  for (double* v : {&k.shear, &k.bend}) *v = std::min(*v, 1e9);
  return k;
}

void random_cloth(Random& random, const weft::Solver& solver, weft::Scene& scene) {
  weft::Cloth& cloth = scene.cloths[0];
  const double stiffest = log_between(random, 1e-3, 1e3);
  cloth.stiffness = random_stiffness(random);
  if (pick(random, 3) == 0) cloth.level = 1 + pick(random, 4);
  if (pick(random, 4) == 0) cloth.stiffness_gradient = random.unit();
  if (solver.method == weft::Method::spring_friction)
    cloth.spring_damping = {stiffest, 0.5 * stiffest, 0.2 * stiffest};
  if (solver.method == weft::Method::positional) cloth.positional_k = 0.5 * random.unit();
  if (pick(random, 2) == 0) cloth.drag = log_between(random, 0.01, 1000);
  if (pick(random, 6) == 0) cloth.bending = log_between(random, 1e-6, 10);
  if (pick(random, 6) == 0) cloth.strain_limit = log_between(random, 0.01, 1);
  if (pick(random, 6) == 0) cloth.tear_strain = log_between(random, 0.01, 1);
  if (pick(random, 8) == 0) {
    const double mass = cloth.particle_mass;
    for (int p = 0; p < cloth.grid.nx * cloth.grid.ny; ++p)
      cloth.masses.push_back(mass * log_between(random, 0.01, 100));
  }
}

}  // namespace

StressCase random_case(std::uint64_t number) {
  Random random(20, number);
  StressCase c;
  const double spacing = log_between(random, 0.005, 0.5);
  c.scene = stress_sheet(4 + pick(random, 13), spacing, log_between(random, 1e-5, 10),
                         pick(random, 3) > 0);
  c.scene.gravity = {0, -log_between(random, 0.1, 981), 0};
  c.scene.solver = random_solver(random);
  random_cloth(random, c.scene.solver, c.scene);
  c.scene.time.frame = log_between(random, 1.0 / 200, 1.0 / 20);
  c.scene.time.substeps =
      pick(random, 3) == 0 ? weft::kAutoSubsteps : int(log_between(random, 1, 200));
  c.start = kStarts[pick(random, 5)];
  c.seconds = 0.5;
  if (pick(random, 3) == 0) c.speed = log_between(random, 0.01, 10);
  c.seed = number;
  return c;
}

}  // namespace bench
