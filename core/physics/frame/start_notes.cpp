// Notes on how cloths start (start_notes.h).
#include "physics/frame/start_notes.h"

#include <algorithm>
#include <cmath>

#include "physics/contact/start_inside.h"
#include "physics/model/lattice/cuts.h"
#include "physics/model/number.h"
#include "physics/model/path.h"
#include "weft/mesh.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

// Pins whose paths begin farther than `distance` from their places on the sheet, and the farthest [m].
struct FarPins {
  int count = 0;
  double most = 0;
};
FarPins far_pins(const Cloth& cloth, double distance) {
  FarPins far;
  for (const Pin& pin : cloth.pins) {
    if (!pin.moves()) continue;
    const Vec3 place = start_of(cloth, pin);
    const Vec3 off = minus(pin_alone_at(pin, place, 0), place);
    const double length = std::sqrt(dot(off, off));
    if (length <= distance) continue;
    ++far.count;
    far.most = std::max(far.most, length);
  }
  return far;
}

// How far neighbours are apart, about [m].
double spacing_of(const Cloth& cloth) {
  return cloth.mesh.given() ? mean_edge(cloth.mesh)
                            : std::min(spacing_u(cloth.grid), spacing_v(cloth.grid));
}

// `surfaces`: whether any cloth meets others by its surface.
void note_thickness(const std::string& which, const Cloth& cloth, bool surfaces,
                    std::vector<std::string>& notes) {
  const SelfCollision& self = cloth.self_collision;
  if (self.mode == SelfCollisionMode::off) return;
  const bool mesh = cloth.mesh.given();
  const double spacing = spacing_of(cloth);
  const std::string thickness = which + ": the thickness of " + number(self.thickness) + " m is ";
  if (self.thickness > spacing)
    notes.push_back(thickness + "above the " + (mesh ? "mean edge of " : "spacing of ") +
                    number(spacing) + " m; particles nearer than the thickness on the " +
                    (mesh ? "mesh at rest" : "flat sheet") + " do not meet");
  // As far as a particle gets from all others, at least.
  const double widest = 0.5 * longest_edge(cloth);
  if (self.mode == SelfCollisionMode::particles && !surfaces && self.thickness < widest)
    notes.push_back(thickness + "below " + number(widest) + " m, half " +
                    (mesh ? "the longest edge" : "the diagonal of a square") +
                    ": particles can pass between others (mode surface lets nothing through)");
}

void note_response(const std::string& which, const SelfCollision& self,
                   std::vector<std::string>& notes) {
  if (self.mode == SelfCollisionMode::off || self.response == SelfCollisionResponse::stiff) return;
  const bool all = self.response == SelfCollisionResponse::course;
  notes.push_back(which + ": " + (all ? "layers and neighbours" : "neighbours on the grid") +
                  " push each other apart by the course's rule, which keeps neither momentum nor "
                  "energy (response stiff does)");
}

// Damping is that of springs: of none, there is none.
void note_damping(const std::string& which, const Scene& scene, const Cloth& cloth,
                  std::vector<std::string>& notes) {
  if (cloth.spring_damping == Kinds{}) return;
  if (scene.solver.method != Method::spring_friction)
    notes.push_back(which +
                    ": spring_damping does nothing, since method spring_friction alone has it");
  if (scene.solver.method != Method::spring_friction || cloth.mesh.given()) return;
  const Kinds &k = cloth.stiffness, &d = cloth.spring_damping;
  const bool level = cloth.level > 0;
  const auto look = [&](const char* kind, double stiffness, double damping, bool of_level) {
    if (damping == 0 || (of_level && stiffness > 0)) return;
    notes.push_back(which + ": spring_damping " + kind + " of " + number(damping) +
                    " N s/m does nothing, since " +
                    (of_level ? "stiffness " + std::string(kind) +
                                    " is 0, and there are no such springs to damp"
                              : "all springs of a level have that of structural"));
  };
  look("structural", k.structural, d.structural, true);
  look("shear", k.shear, d.shear, !level);
  look("bend", k.bend, d.bend, !level);
}

void note_uv_scale(const std::string& which, const ClothMesh& mesh,
                   std::vector<std::string>& notes) {
  if (mesh.uv_scale == ClothMesh{}.uv_scale || mesh.rest == MeshRest::uv) return;
  notes.push_back(which + ": uv_scale of " + number(mesh.uv_scale) +
                  " m does nothing, since its shape at rest is not that of the texture coordinates "
                  "(rest uv)");
}

// An axis alone turns nothing.
bool has_no_turn(const Rotation& rotation) {
  return rotation != Rotation{} && rotation.keys.empty();
}

constexpr const char* kNoTurn =
    "rotate does nothing, since it has no keys (one key, [[0, degrees]], is a fixed turn)";

// Whether a cut of the scene passes between two neighbours.
bool crosses_sheet(const CutLine& cut, const Grid& grid) {
  bool crosses = false;
  for (const auto& [di, dj] : {std::pair(1, 0), {0, 1}})
    for_each_cut({cut}, grid, di, dj, [&](int, int, double) { crosses = true; });
  return crosses;
}

}  // namespace

void note_starts(const Scene& scene, const Cloths& cloths, SheetContact* contact,
                 std::vector<std::string>& notes) {
  if (!scene.gravity_keys.empty())
    notes.push_back("gravity follows its keys from " + number(scene.gravity_keys.front().time) +
                    " to " + number(scene.gravity_keys.back().time) + " s");
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const std::string which = "cloth " + std::to_string(c);
    for (std::size_t k = 0; k < scene.colliders.size(); ++k) {
      const StartInside& start = cloths[c]->starts()[k];
      if (start.particles == 0 && start.triangles == 0) continue;
      const bool course = scene.colliders[k].friction.model == FrictionModel::course;
      const double deepest = std::max(start.deepest_particle, start.deepest_triangle);
      notes.push_back(
          which + " starts inside collider " + std::to_string(k) + ": " +
          std::to_string(start.particles) + " particles, " +
          (start.triangles > 0 ? std::to_string(start.triangles) + " triangles, " : "") + "up to " +
          number(deepest) + " m deep; " +
          (course ? "they are put out at once, as the course does"
                  : "moved out over " + std::to_string(kPulledFrames) + " frames"));
    }
    const Cloth& cloth = scene.cloths[c];
    note_thickness(which, cloth, contact && contact->pairs().surfaces(), notes);
    note_damping(which, scene, cloth, notes);
    note_response(which, cloth.self_collision, notes);
    note_uv_scale(which, cloth.mesh, notes);
    const auto idle =
        std::ranges::count_if(cloth.pins, [](const Pin& pin) { return has_no_turn(pin.rotate); });
    if (idle > 0)
      notes.push_back(which + ", " + std::to_string(idle) + (idle == 1 ? " pin: " : " pins: ") +
                      kNoTurn);
    if (const FarPins far = far_pins(cloth, spacing_of(cloth)); far.count > 0)
      notes.push_back(which + ": " + std::to_string(far.count) +
                      (far.count == 1 ? " pin starts " : " pins start up to ") + number(far.most) +
                      " m from where the sheet has " + (far.count == 1 ? "it" : "them") +
                      " (a pin with keys begins where they say); the sheet is stretched there");
    for (std::size_t k = 0; k < cloth.cuts.size(); ++k)
      if (!crosses_sheet(cloth.cuts[k], cloth.grid))
        notes.push_back(which + ": cut " + std::to_string(k) + " passes between no two particles");
  }
  for (std::size_t k = 0; k < scene.colliders.size(); ++k)
    if (has_no_turn(scene.colliders[k].rotate))
      notes.push_back("collider " + std::to_string(k) + ": " + kNoTurn);
  if (!contact) return;
  if (const SelfContact::Overlaps o = contact->overlaps(); o.pairs > 0)
    notes.push_back(std::to_string(o.pairs) +
                    " pairs of particles start nearer than the thickness, by up to " +
                    number(o.deepest) + " m; they are pushed apart");
  if (const std::size_t crossings = contact->crossings(); crossings > 0)
    notes.push_back(
        std::to_string(crossings) + " edges pass through triangles of cloth at the start; " +
        (contact->pairs().surfaces()
             ? "the smaller part of what meets is taken through, row by row"
             : "their particles are kept apart on the sides where they are (mode surface takes "
               "such sheets apart)"));
}

}  // namespace weft::physics
