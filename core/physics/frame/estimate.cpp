// Memory and time of a run, from counts and measured constants (weft/estimate.h).
#include "weft/estimate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "physics/contact/body/body_surface.h"
#include "physics/contact/moving_collider.h"
#include "physics/frame/time_step.h"
#include "physics/model/lattice/stability.h"
#include "physics/model/lattice/stencil.h"
#include "physics/model/path.h"
#include "physics/model/spectrum.h"
#include "weft/mesh.h"
#include "weft/simulation.h"

namespace weft {

using namespace physics;

namespace {

// Bytes a particle, measured as peak resident memory of `weft run` on sheets of 100 to 1000 points a
// side (bench/estimate): what every scene needs, and what a feature adds.
namespace memory {
constexpr double kProgram = 9e6;  // bytes, whatever the scene
constexpr double kState = 380;    // both lattices, what a frame goes back to, measuring
constexpr double kProjection = 25;
constexpr double kJacobi = 20;
constexpr double kOrder2 = 60;
constexpr double kTethers = 35;
constexpr double kTearing = 60;
constexpr double kMasses = 40;
constexpr double kParticles = 430;  // contact of a folded sheet; 230 where it lies flat
constexpr double kSurface = 1100;   // 900 where it lies flat
constexpr double kMeshVertex = 2500;
constexpr double kMeshTearing = 1100;  // and vertex
constexpr double kMeshBody = 160;      // and body that is a mesh
}  // namespace memory

// Nanoseconds on one thread of a current x86-64 core with AVX-512, measured as docs/benchmarks.md tells
// and raised by a third, for what a whole program meets: a constraint, or a particle, and substep.
namespace cost {
constexpr double kFrame = 20e3, kSubstep = 400;  // a cloth
constexpr double kFrameParticle = 12;            // a particle and frame: saving, looking, measuring
constexpr double kSpring = 0.5, kDampedSpring = 0.75;
constexpr double kGaussSeidel = 1.0, kJacobi = 0.6, kLine = 1.3;    // and sweep
constexpr double kMembrane = 1.6, kSpringBend = 2, kSweepBend = 5;  // from here on: a particle
constexpr double kCell = 9, kMembraneLines = 10;                    // and sweep, of a membrane
constexpr double kVertex = 9, kBentVertex = 18;                     // of a mesh
constexpr double kEdge = 1.6, kStrandEdge = 5, kBentSweep = 25;     // and of its sweeps
constexpr double kTriangle = 20, kStrandStress = 60;  // of a membrane's; of its edges in strands
constexpr double kProjection = 1.2, kTethers = 1.5;
constexpr double kStrainLimit = 1.2, kHeldLimit = 12, kTearing = 0.6, kWind = 0.8;
constexpr double kCollider = 0.5, kBox = 20;       // and collider; a box meets whole triangles
constexpr double kMeshTearing = 6;                 // edges of a vertex
constexpr double kSmall = 500;                     // and collider that is small against the mesh
constexpr double kParticles = 15, kSurface = 130;  // contact of a sheet that lies on itself
}  // namespace cost

bool is_spring(Method method) {
  return method == Method::spring || method == Method::spring_friction;
}

// The corner of a grid, as heavy as its lightest particle.
void cut_grid(const Cloth& from, Cloth& piece) {
  constexpr int kPoints = 24;  // a side; the longest constraint spans 8
  const Grid& grid = from.grid;
  piece.grid.nx = std::min(grid.nx, kPoints);
  piece.grid.ny = std::min(grid.ny, kPoints);
  for (int k = 0; k < 3; ++k) {
    piece.grid.u[k] = grid.u[k] * (piece.grid.nx - 1) / (grid.nx - 1);
    piece.grid.v[k] = grid.v[k] * (piece.grid.ny - 1) / (grid.ny - 1);
  }
  piece.lumping = lumps_by_area(from) ? Lumping::area : Lumping::equal;
  if (from.particle_mass == 0 && from.masses.empty() && lumps_by_area(from))
    piece.density = from.density;
  else
    piece.particle_mass = lightest_mass(from);
  piece.level = from.level;
}

// A cutting of a cloth with the same springs; a mesh whole, since its finest triangles may be anywhere.
Cloth cutting(const Cloth& from) {
  Cloth piece;
  if (from.mesh.given()) {
    piece.mesh = from.mesh;
    piece.sewing = from.sewing;
    piece.seams = from.seams;
    piece.pressure = from.pressure;
    piece.density = from.density;
  } else {
    cut_grid(from, piece);
  }
  piece.stiffness = from.stiffness;
  piece.membrane = from.membrane;
  piece.spring_damping = from.spring_damping;
  piece.bending = from.bending;
  return piece;
}

// Small, but with the substeps and the method of the whole.
Scene cutting(const Scene& from) {
  Scene scene;
  scene.time = from.time;
  scene.solver = from.solver;
  for (const Cloth& cloth : from.cloths)
    if (Cloth piece = cutting(cloth); std::ranges::find(scene.cloths, piece) == scene.cloths.end())
      scene.cloths.push_back(std::move(piece));
  return scene;
}

struct Way {
  Solver solver;
  int substeps;
};

// Calls visit(a, b) for particles that an edge joins.
template <class Visit>
void for_each_edge(const Cloth& cloth, const Visit& visit) {
  if (cloth.mesh.given()) {
    for (const auto& [a, b, c] : cloth.mesh.shape->triangles) visit(a, b), visit(b, c), visit(c, a);
    return;
  }
  const Grid& grid = cloth.grid;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const int p = particle_number(grid, i, j);
      if (i + 1 < grid.nx) visit(p, p + 1);
      if (j + 1 < grid.ny) visit(p, p + grid.nx);
    }
}

std::vector<Vec3> starts_of(const Cloth& cloth) {
  if (cloth.mesh.given()) return placed_vertices(cloth.mesh);
  std::vector<Vec3> starts;
  for (int j = 0; j < cloth.grid.ny; ++j)
    for (int i = 0; i < cloth.grid.nx; ++i) starts.push_back(place_on(cloth.grid, i, j));
  return starts;
}

// How far pins draw the ends of an edge apart within some seconds, in lengths at the start: looked at at keys and
// at times in between. What they follow is taken to move both alike, as it does unless it bends or turns.
double stretch_between_pins(const Cloth& cloth, double seconds) {
  constexpr int kLooks = 64;
  std::map<int, Pin> pins;
  std::set<double> times{0};
  for (const Pin& pin : single_pins(cloth)) {
    for (const Key& key : pin.keys) times.insert(key.time);
    for (const Angle& key : pin.rotate.keys) times.insert(key.time);
    pins.emplace(particle_number(cloth, pin), pin);
  }
  if (times.size() == 1 && times.contains(0)) return 1;
  for (int n = 1; n <= kLooks; ++n) times.insert(seconds * n / kLooks);
  times.erase(times.upper_bound(seconds), times.end());
  const std::vector<Vec3> starts = starts_of(cloth);
  double most = 1;
  for_each_edge(cloth, [&](int a, int b) {
    const auto one = pins.find(a), other = pins.find(b);
    if (one == pins.end() || other == pins.end()) return;
    if (!one->second.moves() && !other->second.moves()) return;
    const Vec3 &p = starts[std::size_t(a)], &q = starts[std::size_t(b)];
    const Vec3 rest = minus(q, p);
    for (const double time : times) {
      const Vec3 edge =
          minus(pin_alone_at(other->second, q, time), pin_alone_at(one->second, p, time));
      most = std::max(most, std::sqrt(dot(edge, edge) / dot(rest, rest)));
    }
  });
  return most;
}

// Of membranes that pins stretch, which takes shorter substeps.
double more_substeps(const Scene& scene) {
  double most = 1;
  for (const Cloth& cloth : scene.cloths)
    if (cloth.membrane.given())
      most = std::max(
          most, std::sqrt(stiffening_of_membrane(stretch_between_pins(cloth, scene.time.seconds))));
  return most;
}

// How the scene will be solved, by a simulation of it, or of cuttings of its cloths, that has just begun.
Way way_of(const Scene& scene, const Simulation& piece) {
  Way way{piece.scene().solver, piece.substeps()};
  if (piece.plan().fallback && is_spring(way.solver.method)) way.solver.method = Method::compliant;
  if (!is_spring(way.solver.method) && scene.time.substeps == kAutoSubsteps)
    way.substeps = projection_substeps(scene);
  else if (scene.time.substeps == kAutoSubsteps)
    way.substeps = int(std::clamp(way.substeps * more_substeps(scene), 1.0, 1e5));
  return way;
}

constexpr double kEdgesOfTriangle = 1.5;  // of a mesh, about

double constraints_of(const Cloth& cloth) {
  if (cloth.mesh.given()) return kEdgesOfTriangle * double(cloth.mesh.shape->triangles.size());
  double count = 0;
  for (const Stencil& f : stencils_of(cloth))
    count += double(std::max(0, f.per_row(cloth.grid.nx))) * std::max(0, cloth.grid.ny - f.dj);
  return count;
}

double bytes_of(const Cloth& cloth, const Solver& solver) {
  const bool projects = !is_spring(solver.method);
  double each = memory::kState;
  if (projects) each += memory::kProjection;
  if (projects && solver.sweep == Sweep::jacobi) each += memory::kJacobi;
  if (solver.order == 2) each += memory::kOrder2;
  if (solver.tethers) each += memory::kTethers;
  if (cloth.tear_strain > 0 || !cloth.cuts.empty()) each += memory::kTearing;
  if (!cloth.masses.empty()) each += memory::kMasses;
  double contact = 0;
  if (cloth.self_collision.mode == SelfCollisionMode::particles) contact = memory::kParticles;
  if (cloth.self_collision.mode == SelfCollisionMode::surface) contact = memory::kSurface;
  if (cloth.mesh.given()) {
    const double tearing = cloth.tear_strain > 0 ? memory::kMeshTearing : 0;
    return (memory::kMeshVertex + tearing + contact) * particle_count(cloth);
  }
  return (each + contact) * row_stride(cloth.grid.nx) * cloth.grid.ny;
}

// Of one substep [ns].
double constraint_cost(const Cloth& cloth, const Solver& solver) {
  const double count = constraints_of(cloth);
  const double particles = particle_count(cloth);
  const double bends = cloth.bending.given() ? particles : 0;
  if (cloth.mesh.given()) {
    if (is_spring(solver.method))
      return particles * (bends > 0 ? cost::kBentVertex : cost::kVertex);
    const bool strands = solver.sweep == Sweep::line;
    const double edge = cloth.membrane.given() ? cost::kTriangle / kEdgesOfTriangle +
                                                     (strands ? cost::kStrandStress : 0)
                        : strands ? cost::kStrandEdge
                                  : cost::kEdge;
    const double tethered = solver.tethers ? cost::kTethers : 0;
    return solver.iterations * count * edge + bends * cost::kBentSweep +
           particles * (cost::kProjection + tethered);
  }
  if (is_spring(solver.method) && cloth.membrane.given())
    return particles * cost::kMembrane + bends * cost::kSpringBend;
  if (solver.method == Method::spring) return count * cost::kSpring + bends * cost::kSpringBend;
  if (solver.method == Method::spring_friction)
    return count * cost::kDampedSpring + bends * cost::kSpringBend;
  const double sweep = solver.sweep == Sweep::jacobi ? cost::kJacobi
                       : solver.sweep == Sweep::line ? cost::kLine
                                                     : cost::kGaussSeidel;
  const double tethers = solver.tethers ? cost::kTethers : 0;
  const bool cells =
      cloth.membrane.given() && solver.method == Method::compliant && solver.sweep != Sweep::jacobi;
  const double stretch =
      !cells ? count * sweep
             : particles * (solver.sweep == Sweep::line ? cost::kMembraneLines : cost::kCell);
  return solver.iterations * (stretch + bends * cost::kSweepBend) +
         particles * (cost::kProjection + tethers);
}

double collider_cost(const Cloth& cloth, const Collider& collider) {
  if (std::holds_alternative<MeshBody>(collider.shape)) return cost::kBox;
  if (!collider.cuts && !resolves(cloth, collider)) return cost::kSmall;
  return std::holds_alternative<Box>(collider.shape) ? cost::kBox : cost::kCollider;
}

double substep_cost(const Scene& scene, const Cloth& cloth, const Solver& solver) {
  double each = 0;
  if (cloth.strain_limit > 0)
    each += cloth.strain_limit_order == StrainLimitOrder::strict ? cost::kHeldLimit
                                                                 : cost::kStrainLimit;
  if (cloth.tear_strain > 0 || !cloth.cuts.empty())
    each += cloth.mesh.given() ? cost::kMeshTearing : cost::kTearing;
  if (scene.wind.drag > 0 || scene.wind.lift > 0) each += cost::kWind;
  for (const Collider& collider : scene.colliders)
    each += solver.collision_iterations * collider_cost(cloth, collider);
  if (cloth.self_collision.mode == SelfCollisionMode::particles) each += cost::kParticles;
  if (cloth.self_collision.mode == SelfCollisionMode::surface) each += cost::kSurface;
  return cost::kSubstep + constraint_cost(cloth, solver) + each * particle_count(cloth);
}

std::string words(double value, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*g %s", value < 100 ? 2 : 3, value, unit);
  return text;
}

Estimate estimate(const Scene& scene, const Way& way) {
  Estimate e;
  e.substeps = way.substeps;
  e.frames = std::round(scene.time.seconds / scene.time.frame);
  e.bytes = memory::kProgram;
  double nanoseconds = 0;
  for (const Cloth& cloth : scene.cloths) {
    e.particles += std::int64_t(particle_count(cloth));
    e.constraints += std::int64_t(constraints_of(cloth));
    e.bytes += bytes_of(cloth, way.solver);
    for (const Collider& collider : scene.colliders)
      if (std::holds_alternative<MeshBody>(collider.shape))
        e.bytes += memory::kMeshBody * particle_count(cloth);
    nanoseconds += cost::kFrame + cost::kFrameParticle * particle_count(cloth) +
                   way.substeps * substep_cost(scene, cloth, way.solver);
  }
  for (const Collider& collider : scene.colliders)
    if (const BodySurface* body = physics::surface_of(collider)) e.bytes += double(body->bytes());
  e.frame_seconds = nanoseconds * 1e-9;
  return e;
}

}  // namespace

Estimate estimate(const Scene& scene) {
  if (auto faults = validate(scene); !faults.empty()) throw SceneError(std::move(faults));
  return estimate(scene, way_of(scene, Simulation(cutting(scene), {.threads = 1})));
}

Estimate estimate(const Simulation& simulation) {
  return estimate(simulation.scene(), way_of(simulation.scene(), simulation));
}

std::string bytes_words(double bytes) {
  if (bytes >= 1e12) return words(bytes * 1e-12, "TB");
  return bytes >= 1e9 ? words(bytes * 1e-9, "GB") : words(std::ceil(bytes * 1e-6), "MB");
}

std::string time_words(double seconds) {
  constexpr double kMinute = 60, kHour = 60 * kMinute, kDay = 24 * kHour, kYear = 365 * kDay;
  if (seconds < 1) return words(seconds * 1e3, "ms");
  if (seconds < 2 * kMinute) return words(seconds, "s");
  if (seconds < 2 * kHour) return words(seconds / kMinute, "min");
  if (seconds < 2 * kDay) return words(seconds / kHour, "h");
  return seconds < 2 * kYear ? words(seconds / kDay, "days") : words(seconds / kYear, "years");
}

}  // namespace weft
