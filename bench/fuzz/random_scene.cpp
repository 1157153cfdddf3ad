#include "random_scene.h"

#include <algorithm>
#include <utility>

#include "random_mesh.h"
#include "random_parts.h"
#include "weft/estimate.h"
#include "weft/shape.h"
#include "weft/simulation.h"

namespace fuzz {

using namespace weft;

namespace {

constexpr std::uint64_t kTears = std::uint64_t{1} << 32;  // streams
constexpr double kFrameWork = 1e6, kSubstepWork = 3e5;    // of one, at most

// Whether there is cloth of anything but springs on a grid.
bool has_more_than_springs(const Scene& scene) {
  return std::any_of(scene.cloths.begin(), scene.cloths.end(),
                     [](const Cloth& c) { return c.mesh.given() || c.membrane.given(); });
}

// Substeps a frame as springs need them, about: the limit is 2/ω with ω² up to four times all springs
// of a particle over its mass.
double estimated_substeps(const Scene& scene) {
  if (scene.time.substeps > 0) return scene.time.substeps;
  if (has_more_than_springs(scene) && validate(scene).empty()) return estimate(scene).substeps;
  double most = scene.time.frame * 960;
  for (const Cloth& c : scene.cloths) {
    double lightest = particle_mass(c, 0, 0);
    for (const double m : c.masses) lightest = std::min(lightest, m);
    const double repeats = scene.solver.iterate_springs ? scene.solver.iterations : 1;
    const double springs =
        repeats * (c.level > 0
                       ? 8 * c.level * c.stiffness.structural
                       : 4 * (c.stiffness.structural + c.stiffness.shear + c.stiffness.bend));
    most = std::max(most, scene.time.frame * std::sqrt(springs / lightest));
  }
  return std::min(most, scene.time.frame * 1e6);
}

// Makes frames shorter where one would be much work.
void shorten_frames(Scene& scene) {
  const double work = work_of_substep(scene) * estimated_substeps(scene);
  if (work <= kFrameWork) return;
  if (scene.time.substeps > 0)
    scene.time.substeps = std::max(1, int(scene.time.substeps * kFrameWork / work));
  else
    scene.time.frame = std::max(1e-5, scene.time.frame * kFrameWork / work);
}

// `tears`: a stream of its own, so that what was drawn before it came is drawn still.
Scene draw_scene(Draw draw, Draw tears) {
  Parts parts(draw);
  Scene scene;
  scene.time = parts.time();
  scene.solver = parts.solver();
  scene.gravity = parts.gravity();
  scene.wind = parts.wind();
  scene.cloths.push_back(parts.cloth(scene.solver, scene.time));
  const double many = draw.uniform(0, 1);
  for (int more = many < 0.7 ? 0 : many < 0.93 ? 1 : draw.between(2, 5); more > 0; --more)
    scene.cloths.push_back(draw.chance(0.6) ? parts.layer(scene.cloths.back())
                                            : parts.cloth(scene.solver, scene.time));
  for (int n = draw.chance(0.5) ? 0 : draw.between(1, 3); n > 0; --n)
    scene.colliders.push_back(parts.collider(scene.cloths[0], scene.time));
  parts.add_motion(scene);
  if (draw.chance(0.3)) parts.add_meshes(scene);
  parts.gather_pins(scene);
  Parts(tears).tear_meshes(scene);
  shorten_frames(scene);
  return scene;
}

}  // namespace

namespace {

// From this seed on some scenes have a gas, which a stream of its own draws: those before stay what they were.
constexpr std::uint64_t kGases = 1'000'000, kStreamOfGases = std::uint64_t{1} << 40;

Scene with_gas(const Scene& scene, std::uint64_t seed) {
  Draw draw(seed, kStreamOfGases);
  if (seed < kGases || draw.chance(0.5)) return scene;
  Parts parts(draw);
  Scene next = scene;
  parts.add_gas(next);
  if (!validate(next).empty()) return scene;
  shorten_frames(next);
  return next;
}

}  // namespace

double work_of_substep(const Scene& scene) {
  const Solver& solver = scene.solver;
  const bool projects = solver.method == Method::positional || solver.method == Method::compliant;
  double families = 1;
  double contact = 0;
  for (const Cloth& c : scene.cloths) {
    families = std::max(families, 1.0 + c.level);
    const double spacing = extent(c).spacing;
    const double crowd = std::max(1.0, std::pow(c.self_collision.thickness / spacing, 2));
    if (c.self_collision.mode == SelfCollisionMode::particles)
      contact = std::max(contact, 8 * crowd);
    if (c.self_collision.mode == SelfCollisionMode::surface)
      contact = std::max(contact, 40 * crowd);
  }
  const double sweep = projects ? solver.iterations * (solver.sweep == Sweep::line ? 8 : 2) : 1;
  double bodies = 0;
  for (const Collider& c : scene.colliders) {
    const bool whole = c.cuts || std::holds_alternative<MeshBody>(c.shape);
    const bool small =
        !whole && std::any_of(scene.cloths.begin(), scene.cloths.end(),
                              [&](const Cloth& cloth) { return !resolves(cloth, c); });
    bodies += small ? 400 : whole ? 20 : 1;
  }
  double particles = 100;  // what a substep costs besides
  for (const Cloth& c : scene.cloths) particles += particle_count(c);
  return particles * (families * sweep + contact + solver.collision_iterations * bodies);
}

Scene random_scene(std::uint64_t seed) {
  for (std::uint64_t stream = 0;; ++stream) {
    Scene scene = with_gas(draw_scene(Draw(seed, stream), Draw(seed, stream + kTears)), seed);
    if (!validate(scene).empty() || work_of_substep(scene) >= kSubstepWork) continue;
    for_each_mesh(scene, [&](auto& mesh, const std::string&) {
      mesh.file = std::to_string(seed) + "-" + mesh.file;
    });
    for (Collider& c : scene.colliders)
      if (!c.animation.empty()) c.animation = std::to_string(seed) + "-" + c.animation;
    return scene;
  }
}

Scene changed_scene(const Scene& scene, Draw& draw) {
  Parts parts(draw);
  Scene next = scene;
  Cloth& cloth = next.cloths[std::size_t(draw.between(0, int(next.cloths.size()) - 1))];
  switch (draw.between(0, 6)) {
    case 0:
      next.gravity = parts.gravity();
      break;
    case 1:
      next.solver = parts.solver();
      break;
    case 2:
      cloth.stiffness = {parts.stiffness(), parts.stiffness(), parts.stiffness()};
      break;
    case 3:
      cloth.pins = parts.pins(cloth, next.time);
      break;
    case 4:
      next.colliders.push_back(parts.collider(cloth, next.time));
      break;
    case 5:
      if (!next.colliders.empty()) next.colliders.pop_back();
      break;
    default:
      next.wind = parts.wind();
      break;
  }
  shorten_frames(next);
  return validate(next).empty() ? next : scene;
}

Vec3 point_near(const Scene& scene, Draw& draw) {
  const Cloth& cloth = scene.cloths[std::size_t(draw.between(0, int(scene.cloths.size()) - 1))];
  const double i = draw.uniform(-0.1, 1.1), j = draw.uniform(-0.1, 1.1);
  Vec3 p;
  double size;
  if (cloth.mesh.given()) {
    const Extent of = extent(cloth);
    p = of.middle;
    size = of.size;
  } else {
    const Grid& g = cloth.grid;
    for (std::size_t k = 0; k < 3; ++k) p[k] = g.origin[k] + i * g.u[k] + j * g.v[k];
    size = std::hypot(g.u[0], g.u[1], g.u[2]);
  }
  const Vec3 off = draw.vector(size * draw.decades(0.01, 2));
  for (std::size_t k = 0; k < 3; ++k) p[k] += off[k];
  return p;
}

}  // namespace fuzz
