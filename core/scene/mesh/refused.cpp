// What meshes do not have (refused.h), key by key.
#include "scene/mesh/refused.h"

#include <algorithm>

namespace weft::text {
namespace {

// Of the cloth itself.
void check_keys(const Cloth& cloth, const std::string& place, Check& result) {
  const auto refuse = [&](bool given, const char* key, const char* what, const char* allowed) {
    if (given) result.fault(place + key, what, allowed);
  };
  refuse(cloth.grid != Grid{}, "/mesh", "both grid and mesh are given", "one of the two");
  refuse(cloth.particle_mass > 0 || !cloth.masses.empty(), "/mesh", "masses are given with a mesh",
         "density");
  refuse(cloth.lumping == Lumping::equal, "/lumping", "the vertices of a mesh are to be alike",
         "auto or area, with a mesh: a vertex weighs what its triangles do");
  const Kinds plain = Cloth{}.stiffness;
  refuse(cloth.stiffness.shear != plain.shear || cloth.stiffness.bend != plain.bend, "/stiffness",
         "shear or bend is given with a mesh", "structural, for all edges alike");
  refuse(cloth.spring_damping.shear > 0 || cloth.spring_damping.bend > 0, "/spring_damping",
         "shear or bend is given with a mesh", "structural, for all edges alike");
  refuse(cloth.level > 0, "/level", "a mesh has a level", "0, with a mesh");
  refuse(cloth.level_diagonals != LevelDiagonals::both, "/level_diagonals", "a mesh has no levels",
         "both, with a mesh");
  refuse(cloth.positional_k != Cloth{}.positional_k, "/positional_k",
         "method positional moves grids alone", "0.5, with a mesh");
  refuse(cloth.stiffness_gradient > 0, "/stiffness_gradient", "a mesh has a gradient",
         "0, with a mesh");
  refuse(cloth.strain_limit_order == StrainLimitOrder::course, "/strain_limit_order",
         "the order is one of grids", "strict or colours, with a mesh");
  refuse(!cloth.cuts.empty(), "/cuts", "a mesh is cut", "none, with a mesh");
  refuse(cloth.tears == Tears::particles, "/tears", "a tear is to take whole vertices of a mesh",
         "split or holes, with a mesh");
  refuse(cloth.self_collision.response != SelfCollisionResponse::stiff, "/self_collision/response",
         "neighbours that push are those of a grid", "stiff, with a mesh");
}

// Of the solver, for a cloth that is a mesh.
void check_method(const Solver& solver, const Cloth& cloth, const std::string& place,
                  Check& result) {
  if (!result.sound("/solver/method")) return;
  if (solver.method == Method::positional)
    result.fault(place + "/mesh", "method positional moves grids alone, and the cloth is a mesh",
                 "method compliant, which is the same where stiffness/structural is 1e9; spring or "
                 "spring_friction");
  if (solver.method != Method::compliant) return;
  if (solver.tethers && cloth.mesh.rest == MeshRest::uv)
    result.fault("/solver/tethers", "tethers are on, and a mesh rests as its texture coordinates",
                 "off, or rest shape, flat or a second mesh file");
  if (solver.sweep == Sweep::jacobi && result.sound("/solver/sweep"))
    result.fault(
        place + "/mesh",
        "sweep jacobi, of means over all constraints, is one of grids, and the cloth is a mesh",
        "sweep gauss_seidel, which leaves as little strain in a fifth of the time, or line");
}

}  // namespace

void check_mesh(const Scene& scene, const Cloth& cloth, const std::string& place, Check& result) {
  check_keys(cloth, place, result);
  check_method(scene.solver, cloth, place, result);
  const bool tears =
      cloth.tear_strain > 0 || std::any_of(scene.colliders.begin(), scene.colliders.end(),
                                           [](const Collider& c) { return c.cuts; });
  const Solver& solver = scene.solver;
  if (tears && cloth.membrane.given() && solver.method == Method::compliant &&
      solver.sweep == Sweep::line && result.sound("/solver/sweep"))
    result.fault("/solver/sweep", "the membrane of a mesh is to tear or to be cut",
                 "gauss_seidel, whose triangles follow tears, or no membrane");
  if (cloth.pressure.given() && tears)
    result.fault(place + "/pressure", "a gas is in a mesh that is to tear or to be cut",
                 "no pressure, or tear_strain 0 and no collider that cuts");
}

}  // namespace weft::text
