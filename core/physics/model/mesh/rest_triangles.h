// The triangles of a mesh at rest: what energies, forces and kernels are made of, in double precision.
//
// Bending: the curvature of a triangle is that of the mean slopes at its sides, weighted by the distances
// of the two triangles' corners there (Onate, Cervera 1993, "Derivation of thin plate bending elements with
// one degree of freedom per node"): k = Σ w n nᵀ h over its sides, h the jump of slope, n the side's normal
// in the triangle, w = l share / area. Held as vectors in space, jumps are linear in the positions, and the
// energy is a quadratic form of them. Regular meshes converge with the square of the edge, whichever way
// their diagonals go; on meshes that are wild plates are about a tenth too stiff. Damping acts on what jumps become along the
// triangle's normal: cloth that turns as a whole is not braked.
#pragma once

#include "physics/model/cloth_model.h"
#include "weft/mesh.h"

namespace weft::physics {

struct RestTriangle {
  std::array<int, 6> corner;  // the triangle's own, and across the side from k to k+1; -1: none
  double du[2], dv[2];        // 1/m; d/du = (x1 - x0) du[0] + (x2 - x0) du[1]
  double area;                // m²
  double rest[3];             // m; of the side from corner k to the next
  double away[3], away_at[3], own[3], own_at[3];  // of the jumps of slope: kernels/mesh.h
  double moment[6];  // their quadratic form, 00 11 22 01 12 20 [N·m³]
};

// `x`: where the vertices are at rest [m]. Warp goes along the first texture coordinate or, where there is
// none, along the x axis, as seen in the triangle; weft at right angles to it.
std::vector<RestTriangle> rest_triangles(const TriangleMesh& mesh, const std::vector<Vec3>& x,
                                         const Bending& bending);

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

// J.
double mesh_energy(const std::vector<RestTriangle>& triangles, const MeshMaterial& material,
                   const std::vector<Vec3>& x);
// Adds -∂E/∂x [N], with damping where velocities `v` are given.
void add_mesh_forces(const std::vector<RestTriangle>& triangles, const MeshMaterial& material,
                     const std::vector<Vec3>& x, const std::vector<Vec3>* v,
                     std::vector<Vec3>& forces);

}  // namespace weft::physics
