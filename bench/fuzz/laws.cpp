#include "laws.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "failure.h"
#include "random_parts.h"
#include "run.h"
#include "weft/mesh.h"
#include "weft/shape.h"

namespace fuzz {

using namespace weft;

namespace {

constexpr double kBound = 15;         // times the energy put in (bench/stress_case.h)
constexpr double kMomentum = 1e-3;    // of Σ m|v|
constexpr double kPosition = 1e-6;    // of coordinates, what single precision makes of them
constexpr double kUnderPlane = 0.01;  // spacings

std::vector<Vec3> as_points(const std::vector<double>& flat, std::size_t first, std::size_t count) {
  std::vector<Vec3> points(count);
  for (std::size_t p = 0; p < count; ++p)
    for (std::size_t k = 0; k < 3; ++k) points[p][k] = flat[3 * (first + p) + k];
  return points;
}

// Calls visit(cloth, positions, velocities) for each cloth.
template <class Visit>
void for_each_cloth(const Simulation& simulation, Visit&& visit) {
  const std::vector<double> x = simulation.positions(), v = simulation.velocities();
  std::size_t first = 0;
  for (const Cloth& c : simulation.scene().cloths) {
    const auto count = std::size_t(particle_count(c));
    visit(c, as_points(x, first, count), as_points(v, first, count));
    first += count;
  }
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

bool has_wind(const Scene& scene) {
  return scene.wind.drag > 0 || scene.wind.lift > 0;
}

bool collides_with_itself(const Scene& scene) {
  return std::any_of(scene.cloths.begin(), scene.cloths.end(), [](const Cloth& c) {
    return c.self_collision.mode != SelfCollisionMode::off;
  });
}

// The course's rule of contact keeps neither momentum nor energy.
bool by_course(const Scene& scene) {
  return std::any_of(scene.cloths.begin(), scene.cloths.end(), [](const Cloth& c) {
    return c.self_collision.mode != SelfCollisionMode::off &&
           c.self_collision.response != SelfCollisionResponse::stiff;
  });
}

// Whether anything moves along keys.
bool driven(const Scene& scene) {
  return !scene.gravity_keys.empty() ||
         std::any_of(scene.colliders.begin(), scene.colliders.end(),
                     [](const Collider& c) { return !c.keys.empty() || !c.rotate.keys.empty(); }) ||
         std::any_of(scene.cloths.begin(), scene.cloths.end(), [](const Cloth& c) {
           return std::any_of(c.pins.begin(), c.pins.end(),
                              [](const Pin& pin) { return pin.moves(); });
         });
}

bool has_meshes(const Scene& scene) {
  return std::any_of(scene.cloths.begin(), scene.cloths.end(),
                     [](const Cloth& c) { return c.mesh.given(); });
}

// No triangle's side is longer [m].
double longest_side(const Cloth& cloth) {
  if (!cloth.mesh.given())
    return spacing_u(cloth.grid) + spacing_v(cloth.grid) + 2 * cloth.grid.jitter;
  const std::vector<Vec3> x = placed_vertices(cloth.mesh);
  double longest = 0;
  for (const auto& t : cloth.mesh.shape->triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = x[std::size_t(t[k])], &b = x[std::size_t(t[(k + 1) % 3])];
      longest = std::max(longest, length({a[0] - b[0], a[1] - b[1], a[2] - b[2]}));
    }
  return longest;
}

// Particles and the triangles between them keep the offset from every collider, now. A triangle lies
// within a diagonal of its corners; above a plane it is where they are.
bool outside_of_all(const Simulation& simulation) {
  bool outside = true;
  for_each_cloth(simulation, [&](const Cloth& cloth, const auto& x, const auto&) {
    const double diagonal = longest_side(cloth);
    for (const Collider& c : simulation.scene().colliders) {
      const double least = c.offset + (std::holds_alternative<Plane>(c.shape) ? 0 : diagonal);
      for (const Vec3& p : x) outside &= signed_distance(c, simulation.time(), p) >= least;
    }
  });
  return outside;
}

// Nothing but the sheet's own forces acts.
bool left_alone(const Scene& scene) {
  return scene.gravity == Vec3{} && scene.gravity_keys.empty() && scene.colliders.empty() &&
         !has_wind(scene) &&
         std::all_of(scene.cloths.begin(), scene.cloths.end(),
                     [](const Cloth& c) { return c.drag == 0 && c.pins.empty(); });
}

bool only_planes(const Scene& scene) {
  return !scene.colliders.empty() &&
         std::all_of(scene.colliders.begin(), scene.colliders.end(), [](const Collider& c) {
           return std::holds_alternative<Plane>(c.shape) && c.keys.empty() &&
                  c.rotate.keys.empty() && !c.cuts;
         });
}

// Whether substeps are so short that positions, which are rounded once in each, do not follow 1 cm/s: what is
// slower gains speed all the same, and falls later.
bool moves_by_steps(const Simulation& simulation) {
  constexpr double kSlow = 0.01;  // m/s
  const Vec3 origin = simulation.view().origin;
  const std::vector<double> x = simulation.positions();
  float size = 0;
  for (std::size_t n = 0; n < x.size(); ++n)
    size = std::max(size, float(std::abs(x[n] - origin[n % 3])));
  const float next = std::nextafter(size, std::numeric_limits<float>::infinity());
  return (next - size) / 2 > kSlow * simulation.dt();
}

bool pinned_anywhere(const Scene& scene) {
  return std::any_of(scene.cloths.begin(), scene.cloths.end(),
                     [](const Cloth& c) { return !c.pins.empty(); });
}

}  // namespace

Laws::Laws(const Simulation& simulation) : springs_(bench::runs_springs(simulation)) {
  const Scene& scene = simulation.scene();
  const bool outside = outside_of_all(simulation);
  together_ = collides_with_itself(scene);
  // What a mesh has of energy is not counted.
  if (!driven(scene) && !has_wind(scene) && !by_course(scene) && outside && !has_meshes(scene) &&
      !moves_by_steps(simulation))
    open_ledgers(simulation);
  momentum_kept_ = left_alone(scene) && !by_course(scene) && scene.solver.sleep == 0;
  momentum_ = simulation.report(false).momentum;
  above_planes_ = only_planes(scene) && scene.colliders.size() == 1 && outside &&
                  !pinned_anywhere(scene) && !by_course(scene);
}

void Laws::open_ledgers(const Simulation& simulation) {
  for_each_cloth(simulation, [&](const Cloth& c, const auto& x, const auto& v) {
    Scene alone = simulation.scene();
    alone.cloths = {c};
    ledgers_.emplace_back(alone, springs_, simulation.dt()).open(x, v);
  });
}

void Laws::frame(const Simulation& simulation) {
  check_energy(simulation);
  check_momentum(simulation);
  check_planes(simulation);
  check_paths(simulation);
}

void Laws::check_energy(const Simulation& simulation) {
  if (springs_ && !bench::runs_springs(simulation)) {
    springs_ = false;
    for (bench::Ledger& ledger : ledgers_) ledger.project_every(simulation.dt());
  }
  if (ledgers_.empty()) return;
  const auto judge = [&](const bench::Ledger::Balance& balance) {
    if (!(balance.share() <= kBound))
      throw Failure("judge energy: " + number(balance.share()) + " times what was put in, frame " +
                    std::to_string(simulation.frame()));
  };
  bench::Ledger::Balance all;
  auto ledger = ledgers_.begin();
  for_each_cloth(simulation, [&](const Cloth&, const auto& x, const auto& v) {
    const bench::Ledger::Balance one = ledger++->balance(x, v);
    all.held += one.held;
    all.put_in += one.put_in;
    if (!together_) judge(one);
  });
  judge(all);
}

void Laws::check_momentum(const Simulation& simulation) {
  if (!momentum_kept_) return;
  double flow = 0;
  const View view = simulation.view();
  auto shown = view.cloths.begin();
  for_each_cloth(simulation, [&](const Cloth&, const auto&, const auto& v) {
    const std::vector<std::size_t> lanes = lanes_of(*shown);
    for (std::size_t p = 0; p < v.size(); ++p)
      flow += length(v[p]) / double(shown->inverse_mass[lanes[p]]);  // none is pinned
    ++shown;
  });
  flow_ = std::max(flow_, flow);
  const Vec3 now = simulation.report(false).momentum;
  const double off = length({now[0] - momentum_[0], now[1] - momentum_[1], now[2] - momentum_[2]});
  if (!(off <= kMomentum * flow_))
    throw Failure("judge momentum: off by " + number(off) + " kg m/s of " + number(flow_) +
                  ", frame " + std::to_string(simulation.frame()));
}

void Laws::check_planes(const Simulation& simulation) const {
  if (!above_planes_) return;
  const Collider& plane = simulation.scene().colliders[0];
  const View view = simulation.view();
  for_each_cloth(simulation, [&](const Cloth& c, const auto& x, const auto&) {
    const double spacing = extent(c).spacing;
    for (const Vec3& p : x) {
      double size = 1;
      for (std::size_t k = 0; k < 3; ++k) size = std::max(size, std::abs(p[k] - view.origin[k]));
      const double depth = plane.offset - signed_distance(plane, simulation.time(), p);
      if (depth > kUnderPlane * spacing + kPosition * size)
        throw Failure("judge plane: " + number(depth) + " m below, frame " +
                      std::to_string(simulation.frame()));
    }
  });
}

// Pins with keys lie on their path, from the start.
void Laws::check_paths(const Simulation& simulation) const {
  const Vec3 origin = simulation.view().origin;
  for_each_cloth(simulation, [&](const Cloth& c, const auto& x, const auto&) {
    for (const Pin& pin : single_pins(c)) {
      if (pin.keys.empty() || pin.follow >= 0 || !pin.rotate.keys.empty()) continue;
      const Vec3 here = x[std::size_t(particle_number(c, pin))];
      const Vec3 there = position_at(pin.keys, simulation.time());
      const double off = length({here[0] - there[0], here[1] - there[1], here[2] - there[2]});
      const double size =
          length({there[0] - origin[0], there[1] - origin[1], there[2] - origin[2]});
      if (off > kPosition * (1 + size))
        throw Failure("judge path: a pin " + number(off) + " m off its path, frame " +
                      std::to_string(simulation.frame()));
    }
  });
}

}  // namespace fuzz
