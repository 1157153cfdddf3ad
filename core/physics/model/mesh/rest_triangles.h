// The triangles of a mesh at rest: what energies, forces and kernels are made of, in double precision.
//
// Bending: the curvature of a triangle is that of the mean slopes at its sides (Onate, Cervera 1993, "Derivation
// of thin plate bending elements with one degree of freedom per node"): k = Σ w n nᵀ h over its sides, h the jump
// of slope, n the side's normal in the triangle, w = l share / area. Held as vectors in space, jumps are linear in
// the positions, and the energy is a quadratic form of them, whose moments plate_moments.h has. Damping acts on
// what jumps become along the triangle's normal: cloth that turns as a whole is not braked.
//
// Curved at rest: a jump counts from what it is at rest as seen from the triangle (Garg, Grinspun, Wardetzky,
// Zorin 2007, "Cubic Shells"). What of it lies in the triangle's plane goes into `own`, so that it stays linear;
// what lies along the normal turns with the product of two sides, p × q `bow`: exact where nothing is stretched,
// without a root, and zero at rest.
#pragma once

#include "physics/model/cloth_model.h"
#include "weft/mesh.h"

namespace weft::physics {

struct RestTriangle {
  std::array<int, 6> corner;  // the triangle's own, and across the side from k to k+1; -1: none
  double du[2], dv[2];        // 1/m; d/du = (x1 - x0) du[0] + (x2 - x0) du[1]
  double area;                // m²; 0 where it has torn
  double rest[3];             // m; of the side from corner k to the next
  double half[3];             // 1, or 0 where that side has torn
  double away[3], away_at[3], own[3], own_at[3];  // of the jumps of slope: kernels/mesh.h
  double bow[3];     // 1/m²; of a jump at rest along the product of the sides from corner 0
  double moment[6];  // their quadratic form, 00 11 22 01 12 20 [N·m³]
};

// What a mesh is like at rest.
struct RestPlaces {
  std::vector<Vec3> x;  // where the vertices are [m]
  bool flat = false;    // whether bending is towards flat, however these lie
  double uv_scale = 0;  // m; above 0: triangles are those of the texture coordinates in place of x
};
RestPlaces rest_places(const ClothMesh& mesh);

// Warp goes along the first texture coordinate or, where there is
// none, along the x axis, as seen in the triangle; weft at right angles to it.
std::vector<RestTriangle> rest_triangles(const TriangleMesh& mesh, const RestPlaces& rest,
                                         const Bending& bending);

// Whether bending is towards a shape that is not flat.
bool is_curved(const std::vector<RestTriangle>& triangles);

// What a cloth's triangles are made of.
struct MeshMaterial {
  bool membrane;
  double c11, c22, c12, c66, damping;
  double stiffness, spring_damping;  // N/m, N·s/m; of a side, from each of its triangles
  bool bends;
  double bend_damping;
  bool damped() const { return damping > 0 || spring_damping > 0 || bend_damping > 0; }
};
// `damped_springs`: method spring_friction.
MeshMaterial material_of(const Cloth& cloth, bool damped_springs);
// What of a material resists bending.
MeshMaterial bending_alone(MeshMaterial material);

// J.
double mesh_energy(const std::vector<RestTriangle>& triangles, const MeshMaterial& material,
                   const std::vector<Vec3>& x);
// Adds -∂E/∂x [N], with damping where velocities `v` are given.
void add_mesh_forces(const std::vector<RestTriangle>& triangles, const MeshMaterial& material,
                     const std::vector<Vec3>& x, const std::vector<Vec3>* v,
                     std::vector<Vec3>& forces);

}  // namespace weft::physics
