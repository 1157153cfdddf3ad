// The surface where a function is zero, as triangles.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vector.h"

namespace mannequin {

using Field = std::function<double(Vec)>;

struct Mesh {
  std::vector<Vec> vertices;                  // m
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from outside
};

// A surface net (Gibson 1998): a vertex in every cell of a grid that the surface passes, a square about every
// edge that it crosses. Vertices are then relaxed along the surface and put on it, so that triangles are nearly
// alike.
Mesh surface_of(const Field& field, Vec low, Vec high, double cell);

// Leaves of a surface only where `kept` is negative, and draws its border to where that is zero.
Mesh cut(const Mesh& mesh, const Field& field, const Field& kept);

// Without small pieces, and without vertices of no triangle: the largest piece alone.
Mesh largest_piece(const Mesh& mesh);

// To the surface of a field, along its gradient.
Vec put_on(const Field& field, Vec p);

void write_obj(const Mesh& mesh, const std::string& path, const std::string& name);

}  // namespace mannequin
