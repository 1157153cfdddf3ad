// Which key of a Weft scene names which field of Scene: stated once, and walked by the reader and
// the writer alike (document.cpp). Order is that of written files.
#pragma once

#include <array>

#include "weft/scene.h"

namespace weft::text {

// Values whose JSON form differs from their fields.
struct Substeps {  // an integer, or "auto" for kAutoSubsteps
  int& value;
};
struct Points {  // [nx, ny]
  int& nx;
  int& ny;
};

struct RestShape {  // a word, or the name of a file
  MeshRest& rest;
  std::string& file;
};

struct ClothPins {  // by column and row of a grid, or by number of a mesh
  std::vector<Pin>& pins;
  bool of_mesh;
};

struct VectorInTime {  // a vector, or {"keys": [[t, x, y, z], …]}
  Vec3& value;
  std::vector<Key>& keys;
};

// The words for the values of each enum, in their order.
constexpr std::array<const char*, 4> words(Method) {
  return {"positional", "spring", "spring_friction", "compliant"};
}
constexpr std::array<const char*, 3> words(Sweep) {
  return {"gauss_seidel", "jacobi", "line"};
}
constexpr std::array<const char*, 3> words(SelfCollisionMode) {
  return {"off", "particles", "surface"};
}
constexpr std::array<const char*, 3> words(SelfCollisionResponse) {
  return {"stiff", "course", "neighbours"};
}

constexpr std::array<const char*, 3> words(Lumping) {
  return {"auto", "area", "equal"};
}

constexpr std::array<const char*, 3> words(Tears) {
  return {"split", "holes", "particles"};
}
constexpr std::array<const char*, 3> words(MeshRest) {
  return {"shape", "flat", "uv"};
}
constexpr std::array<const char*, 2> words(LevelDiagonals) {
  return {"both", "one"};
}
constexpr std::array<const char*, 3> words(StrainLimitOrder) {
  return {"colours", "course", "strict"};
}

template <class Walk>
void fields(Walk& walk, Rotation& rotation) {
  walk("axis", rotation.axis);
  walk("about", rotation.about);
  walk("keys", rotation.keys);
}

template <class Walk>
void fields(Walk& walk, Time& time) {
  walk("frame", time.frame);
  walk("substeps", Substeps{time.substeps});
  walk("seconds", time.seconds);
}

template <class Walk>
void fields(Walk& walk, Solver& solver) {
  walk("method", solver.method);
  walk("sweep", solver.sweep);
  walk("tethers", solver.tethers);
  walk("order", solver.order);
  walk("iterations", solver.iterations);
  walk("iterate_springs", solver.iterate_springs);
  walk("full_first_kick", solver.full_first_kick);
  walk("collision_iterations", solver.collision_iterations);
  walk("sleep", solver.sleep);
}

template <class Walk>
void fields(Walk& walk, Grid& grid) {
  walk("points", Points{grid.nx, grid.ny});
  walk("origin", grid.origin);
  walk("u", grid.u);
  walk("v", grid.v);
  walk("jitter", grid.jitter);
}

template <class Walk>
void fields(Walk& walk, MeshSource& mesh) {
  walk("file", mesh.file);
  walk("scale", mesh.scale);
  walk("rotate", mesh.rotate);
  walk("translate", mesh.translate);
}

template <class Walk>
void fields(Walk& walk, ClothMesh& mesh) {
  fields(walk, static_cast<MeshSource&>(mesh));
  walk("rest", RestShape{mesh.rest, mesh.at_rest.file});
  walk("uv_scale", mesh.uv_scale);
}

template <class Walk>
void fields(Walk& walk, Kinds& kinds) {
  walk("structural", kinds.structural);
  walk("shear", kinds.shear);
  walk("bend", kinds.bend);
}

template <class Walk>
void fields(Walk& walk, Membrane& membrane) {
  walk("warp", membrane.warp);
  walk("weft", membrane.weft);
  walk("coupling", membrane.coupling);
  walk("shear", membrane.shear);
  walk("damping", membrane.damping);
}

template <class Walk>
void fields(Walk& walk, Pressure& pressure) {
  walk("over", pressure.over);
  walk("inflate", pressure.inflate);
  walk("ambient", pressure.ambient);
  walk("keys", pressure.keys);
}

template <class Walk>
void fields(Walk& walk, SelfCollision& self) {
  walk("mode", self.mode);
  walk("thickness", self.thickness);
  walk("friction", self.friction);
  walk("response", self.response);
}

template <class Walk>
void fields(Walk& walk, ClothColor& color) {
  walk("front", color.front);
  walk("back", color.back);
}

template <class Walk>
void fields(Walk& walk, Cloth& cloth) {
  walk("grid", cloth.grid);
  walk("mesh", cloth.mesh);
  walk("density", cloth.density);
  walk("particle_mass", cloth.particle_mass);
  walk("masses", cloth.masses);
  walk("lumping", cloth.lumping);
  walk("stiffness", cloth.stiffness);
  walk("spring_damping", cloth.spring_damping);
  walk("membrane", cloth.membrane);
  walk("level", cloth.level);
  walk("level_diagonals", cloth.level_diagonals);
  walk("stiffness_gradient", cloth.stiffness_gradient);
  walk("positional_k", cloth.positional_k);
  walk("velocity", cloth.velocity);
  walk("spin", cloth.spin);
  walk("drag", cloth.drag);
  walk("bending", cloth.bending);
  walk("strain_limit", cloth.strain_limit);
  walk("strain_limit_order", cloth.strain_limit_order);
  walk("tear_strain", cloth.tear_strain);
  walk("tears", cloth.tears);
  walk("self_collision", cloth.self_collision);
  walk("pins", ClothPins{cloth.pins, cloth.mesh.given()});
  walk("cuts", cloth.cuts);
  walk("sewing", cloth.sewing);
  walk("seams", cloth.seams);
  walk("pressure", cloth.pressure);
  walk("color", cloth.color);
}

// Of the shapes of colliders (weft/shapes/value.h).
template <class Walk, class Shape>
requires requires {
  &Shape::half_thickness;
}
void fields(Walk& walk, Shape& shape) {
  Shape::values(shape, [&](const char* key, auto& value, ShapeValue) { walk(key, value); });
}

template <class Walk>
void fields(Walk& walk, MeshBody& body) {
  fields(walk, static_cast<MeshSource&>(body));
}

template <class Walk>
void fields(Walk& walk, Collider& collider) {
  walk(collider.shape);  // under the key of its kind
  walk("friction", collider.friction);
  walk("offset", collider.offset);
  walk("keys", collider.keys);
  walk("rotate", collider.rotate);
  walk("animation", collider.animation);
  walk("cuts", collider.cuts);
  walk("color", collider.color);
}

template <class Walk>
void fields(Walk& walk, Wind& wind) {
  walk("velocity", VectorInTime{wind.velocity, wind.velocity_keys});
  walk("drag", wind.drag);
  walk("lift", wind.lift);
  walk("turbulence", wind.turbulence);
}

template <class Walk>
void fields(Walk& walk, Sight& camera) {
  walk("azimuth", camera.azimuth);
  walk("elevation", camera.elevation);
  walk("zoom", camera.zoom);
}

template <class Walk>
void fields(Walk& walk, Scene& scene) {
  walk("name", scene.name);
  walk("about", scene.about);
  walk("gravity", VectorInTime{scene.gravity, scene.gravity_keys});
  walk("time", scene.time);
  walk("solver", scene.solver);
  walk("cloths", scene.cloths);
  walk("colliders", scene.colliders);
  walk("wind", scene.wind);
  walk("camera", scene.camera);
}

}  // namespace weft::text
