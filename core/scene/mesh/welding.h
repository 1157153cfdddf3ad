// Vertices that are one: copies that a format makes for texture coordinates and normals.
#pragma once

#include <functional>
#include <vector>

#include "weft/scene.h"

namespace weft::text {

// Of every vertex, the first that lies in exactly the same place, by their numbers.
std::vector<int> firsts_in_place(const std::vector<Vec3>& vertices);

// Parts vertices from the first of theirs where apart(first, vertex) says so: such a vertex joins one that was parted
// from the same first before and that it is not apart from, or is a first itself. Takes time in proportion: beyond
// eight that part from one vertex, all others are by themselves.
void part(std::vector<int>& firsts, const std::function<bool(int first, int vertex)>& apart);

// The new numbers of vertices when only firsts are left, in their order.
std::vector<int> numbers_of(const std::vector<int>& firsts);

// Makes one of vertices that lie in exactly one place, and keeps the order of those that are left. Returns the new
// number of each of them.
std::vector<int> weld(std::vector<Vec3>& vertices);

}  // namespace weft::text
