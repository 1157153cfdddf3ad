// Random triangle meshes: cloth and bodies of any shape.
#pragma once

#include <memory>
#include <string>

#include "draw.h"
#include "weft/mesh.h"

namespace fuzz {

// A sheet of nx by ny points (2 or more each) over the unit square of the plane y = 0, or a tube, a disc, or
// two pieces of it: points moved, any diagonals, holes, vertices in any order, some with uv. Null where the
// reader would refuse it.
std::shared_ptr<const weft::TriangleMesh> random_sheet(Draw& draw, int nx, int ny);

// About as large as the unit ball: closed and round, or a sheet.
std::shared_ptr<const weft::TriangleMesh> random_body(Draw& draw);

// A way that the vertices of a mesh go: it turns, grows, shrinks, is moved and shaken. `frame` [s]: of the scene.
std::shared_ptr<const weft::PointCache> random_motion(Draw& draw, const weft::TriangleMesh& mesh,
                                                      double frame);

// Meshes of a scene are known by the names of their files. Gives those of `to` what `from` has read.
void adopt_meshes(weft::Scene& to, const weft::Scene& from);

// Writes the files of a scene's meshes.
void write_meshes(const weft::Scene& scene, const std::string& folder);

}  // namespace fuzz
